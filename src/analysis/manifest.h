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

/// manifest.json maps the files of a folder to the results that contain them.
namespace trackbed {

/// Accumulates size and SHA-256 of a content.
class EntryMaker {
 public:
  void Add(std::string_view content);
  /// Returns the entry of the added content. Finish() must be the last call on an EntryMaker.
  [[nodiscard]] ManifestEntry Finish();

 private:
  Sha256Sum sum_;
  std::size_t size_ = 0;
};

ManifestEntry MakeManifestEntry(std::string_view content);

/// Entries of a result's files, keyed by file name.
using ResultFiles = std::map<std::string, ManifestEntry>;

/// Entries of a folder, keyed by the name of the result.
struct Manifest {
  std::map<std::string, ResultFiles> results;
  std::set<std::string> others;  ///< files of results of which other files are missing or replaced

  /// Whether Trackbed has written a file of this name.
  [[nodiscard]] bool Lists(const std::string& name) const;

  /// Adds a result. Drops other results that the added result makes incomplete, because it replaces
  /// one of their files by a different one or because one of their files is among the `removed`.
  void Take(const std::string& result, ResultFiles files, const std::vector<std::string>& removed);
  [[nodiscard]] std::string ToJson() const;
};

/// Reads the manifest of a folder. Returns none if the folder has no manifest. ReadManifest throws
/// InputError naming the file if the manifest is invalid.
std::optional<Manifest> ReadManifest(const std::filesystem::path& folder);

/// Throws InputError naming `file` if the file differs from its entry in the folder's manifest.
/// RequireInManifest also throws if the entry is missing although the manifest has a result of that
/// kind. RequireInManifest reads the whole file.
void RequireInManifest(const std::filesystem::path& file);

}  // namespace trackbed
