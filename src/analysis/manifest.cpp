#include "src/analysis/manifest.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void EntryMaker::Add(std::string_view content) {
  sum_.Add(content);
  size_ += content.size();
}

ManifestEntry EntryMaker::Finish() {
  return {size_, sum_.Finish()};
}

ManifestEntry EntryOf(std::string_view content) {
  return {content.size(), Sha256(content)};
}

void Manifest::Take(const std::string& result, ResultFiles files,
                    const std::vector<std::string>& removed) {
  std::erase_if(results, [&](const auto& other) {
    return std::any_of(other.second.begin(), other.second.end(), [&](const auto& file) {
      const auto taken = files.find(file.first);
      return taken != files.end()
                 ? taken->second != file.second
                 : std::find(removed.begin(), removed.end(), file.first) != removed.end();
    });
  });
  results[result] = std::move(files);
}

std::string Manifest::ToJson() const {
  ordered_json json;
  for (const auto& [result, files] : results) {
    for (const auto& [name, entry] : files) {
      json["results"][result][name] = {{"bytes", entry.size}, {"sha256", entry.sha256}};
    }
  }
  return json.dump(2) + "\n";
}

std::optional<Manifest> ReadManifest(const fs::path& folder) {
  const fs::path file = folder / run_folder::kManifest;
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(file, ignored);
  if (!fs::exists(status)) {
    return std::nullopt;
  }
  if (!fs::is_regular_file(status)) {
    throw InputError(Problem{.file = file.string(), .message = "is no regular file"});
  }
  try {
    Manifest manifest;
    const ordered_json json = ParseJson(file);
    for (const auto& [result, files] : json.at("results").items()) {
      for (const auto& [name, entry] : files.items()) {
        manifest.results[result][name] = {entry.at("bytes").get<std::size_t>(),
                                          entry.at("sha256").get<std::string>()};
      }
    }
    return manifest;
  } catch (const nlohmann::json::exception&) {
    throw InputError(Problem{.file = file.string(), .message = "not the manifest of a folder"});
  }
}

namespace {

/// The results that have files of this name.
std::vector<std::string> ResultsWith(const std::string& name) {
  if (name == run_folder::kCompareCsv || name == run_folder::kCompareJson) {
    return {run_folder::kComparison};
  }
  if (name == run_folder::kSweepCsv || name == run_folder::kSweepJson) {
    return {run_folder::kStudy};
  }
  return {run_folder::kRun, run_folder::kPlan};
}

bool IsInNone(const std::string& name) {
  using namespace run_folder;
  return name == kManifest || name == kVideo || name == kPicture || name == kReport ||
         name == kTimingJson;
}

}  // namespace

void RequireInManifest(const fs::path& file) {
  const fs::path folder = file.parent_path();
  const std::string name = file.filename();
  std::error_code ignored;
  if (fs::exists(folder / run_folder::kComplete, ignored)) {
    throw InputError(Problem{.file = file.string(),
                             .message = "its folder is between two results: the program that moved "
                                        "the new one into place was interrupted; run it again"});
  }
  const std::optional<Manifest> manifest = IsInNone(name) ? std::nullopt : ReadManifest(folder);
  if (!manifest) {
    return;
  }
  bool told_of = false;
  std::optional<ManifestEntry> own;
  for (const std::string& result : ResultsWith(name)) {
    const auto files = manifest->results.find(result);
    if (files == manifest->results.end()) {
      continue;
    }
    told_of = true;
    if (const auto entry = files->second.find(name); entry != files->second.end()) {
      if (fs::file_size(file, ignored) == entry->second.size) {
        own = own ? own : EntryOf(ReadFile(file));
        if (entry->second == *own) {
          return;
        }
      }
    }
  }
  if (told_of) {
    throw InputError(Problem{
        .file = file.string(),
        .message = "does not belong to this run: written by another (interrupted) run, or changed "
                   "since (manifest.json has the SHA-256 of its files); run it again"});
  }
}

}  // namespace trackbed
