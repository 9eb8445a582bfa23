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

/// Reads and writes manifest.json, which lists for each result in a folder the files of the result.
namespace trackbed {

/// Computes the manifest entry of a file (its size and SHA-256) from the file's content, which may
/// be added in several parts.
class EntryMaker {
 public:
  void Add(std::string_view content);
  /// Returns the manifest entry of the file whose content was added. Do not call any function of
  /// the EntryMaker after Finish().
  [[nodiscard]] ManifestEntry Finish();

 private:
  Sha256Sum sum_;
  std::size_t size_ = 0;
};

ManifestEntry MakeManifestEntry(std::string_view content);

/// Manifest entries of the files of one result, keyed by file name.
using ResultFiles = std::map<std::string, ManifestEntry>;

/// Manifest of a folder: the file entries of each result, keyed by the name of the result.
struct Manifest {
  std::map<std::string, ResultFiles> results;
  /// Files that remain of incomplete results, whose other files were removed or replaced.
  std::set<std::string> others;

  /// Returns whether the manifest lists a file with this name as written by Trackbed.
  [[nodiscard]] bool Lists(const std::string& name) const;

  /// Adds a result to the manifest. Drops every older result that becomes incomplete, because the
  /// new result replaces one of the older result's files or because `removed` lists a file of the
  /// older result.
  void Take(const std::string& result, ResultFiles files, const std::vector<std::string>& removed);
  [[nodiscard]] std::string ToJson() const;
};

/// Reads the manifest of a folder. Returns nullopt if the folder has no manifest. ReadManifest
/// throws InputError naming the file if the manifest is invalid.
std::optional<Manifest> ReadManifest(const std::filesystem::path& folder);

/// Throws InputError naming `file` if the file differs from its entry in the manifest of its
/// folder. RequireInManifest also throws if the manifest lists a result that should contain the
/// file but has no entry for the file. RequireInManifest reads the whole file.
void RequireInManifest(const std::filesystem::path& file);

}  // namespace trackbed
