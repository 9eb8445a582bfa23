#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/core/hash.h"

/// manifest.json: which files belong to the results in a folder.
namespace trackbed {

/// Size and SHA-256 of what is added.
class EntryMaker {
 public:
  void Add(std::string_view content);
  /// Call last.
  [[nodiscard]] ManifestEntry Finish();

 private:
  Sha256Sum sum_;
  std::size_t size_ = 0;
};

ManifestEntry EntryOf(std::string_view content);

/// By the name of the file.
using ResultFiles = std::map<std::string, ManifestEntry>;

/// By the name of the result.
struct Manifest {
  std::map<std::string, ResultFiles> results;

  /// Puts in a result, without those that it leaves no longer whole: a file of theirs is replaced
  /// by another, or `removed`.
  void Take(const std::string& result, ResultFiles files, const std::vector<std::string>& removed);
  [[nodiscard]] std::string ToJson() const;
};

/// Of the folder; none if it has none. InputError naming the file when it cannot be understood.
std::optional<Manifest> ReadManifest(const std::filesystem::path& folder);

/// InputError naming `file` unless it is as the manifest of its folder says: one that the manifest
/// names, or of a kind of result that the manifest has nothing of. Reads the file.
void RequireInManifest(const std::filesystem::path& file);

}  // namespace trackbed
