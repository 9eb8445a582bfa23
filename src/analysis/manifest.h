#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/core/hash.h"

/// manifest.json: maps files of a folder to the results that they belong to.
namespace trackbed {

/// Accumulates size and SHA-256 of a content.
class EntryMaker {
 public:
  void Add(std::string_view content);
  /// Returns the entry. Must be the last call.
  [[nodiscard]] ManifestEntry Finish();

 private:
  Sha256Sum sum_;
  std::size_t size_ = 0;
};

ManifestEntry MakeManifestEntry(std::string_view content);

/// Entries of a result's files, by file name.
using ResultFiles = std::map<std::string, ManifestEntry>;

/// Entries of a folder, by name of the result.
struct Manifest {
  std::map<std::string, ResultFiles> results;
  std::set<std::string> others;  ///< files of results that are no longer whole

  /// Whether Trackbed has written a file of this name.
  [[nodiscard]] bool Lists(const std::string& name) const;

  /// Adds a result. Drops other results that this makes incomplete: one of their files is replaced
  /// by a different one, or is among the `removed`.
  void Take(const std::string& result, ResultFiles files, const std::vector<std::string>& removed);
  [[nodiscard]] std::string ToJson() const;
};

/// Reads the manifest of a folder; none if the folder has none. Throws InputError naming the file
/// if it is invalid.
std::optional<Manifest> ReadManifest(const std::filesystem::path& folder);

/// Throws InputError naming `file` if it differs from its entry in the folder's manifest, or is
/// missing there although the manifest has a result of its kind. Reads the file.
void RequireInManifest(const std::filesystem::path& file);

}  // namespace trackbed
