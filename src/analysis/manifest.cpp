#include "src/analysis/manifest.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr const char* kNoManifest =
    "not the manifest of a folder of Trackbed's; choose another folder, or move the file away";

}  // namespace

void EntryMaker::Add(std::string_view content) {
  sum_.Add(content);
  size_ += content.size();
}

ManifestEntry EntryMaker::Finish() {
  return {size_, sum_.Finish()};
}

ManifestEntry MakeManifestEntry(std::string_view content) {
  return {content.size(), Sha256(content)};
}

bool Manifest::Lists(const std::string& name) const {
  return others.contains(name) ||
         std::any_of(results.begin(), results.end(), [&](const auto& result) {
           // The manifest entry of a result omits timing.json, because the computing times differ
           // even between equal runs.
           return result.second.contains(name) ||
                  (name == run_folder::kTimingJson && IsNameOf(result.first, name));
         });
}

void Manifest::Take(const std::string& result, ResultFiles files,
                    const std::vector<std::string>& removed) {
  std::erase_if(results, [&](const auto& other) {
    const bool dropped =
        std::any_of(other.second.begin(), other.second.end(), [&](const auto& file) {
          const auto taken = files.find(file.first);
          return taken != files.end()
                     ? taken->second != file.second
                     : std::find(removed.begin(), removed.end(), file.first) != removed.end();
        });
    if (dropped) {
      for (const auto& file : other.second) {
        others.insert(file.first);
      }
      if (IsNameOf(other.first, run_folder::kTimingJson)) {
        others.insert(run_folder::kTimingJson);
      }
    }
    return dropped;
  });
  results[result] = std::move(files);
  std::erase_if(others, [&](const std::string& name) {
    return std::find(removed.begin(), removed.end(), name) != removed.end() ||
           std::any_of(results.begin(), results.end(), [&](const auto& own) {
             return own.second.contains(name) ||
                    (name == run_folder::kTimingJson && IsNameOf(own.first, name));
           });
  });
}

std::string Manifest::ToJson() const {
  ordered_json json;
  for (const auto& [result, files] : results) {
    for (const auto& [name, entry] : files) {
      json["results"][result][name] = {{"bytes", entry.size}, {"sha256", entry.sha256}};
    }
  }
  if (!others.empty()) {
    json["others"] = others;
  }
  return JsonText(json);
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
    // A manifest.json may be from another program, because web pages and browser extensions also
    // have a manifest.json.
    const ordered_json json = ParseJson(file);
    if (!json.at("results").is_object() || json.size() > (json.contains("others") ? 2U : 1U)) {
      throw InputError(Problem{.file = file.string(), .message = kNoManifest});
    }
    const JsonValue root(json, file.string());
    constexpr auto kAnySize = std::numeric_limits<std::uint64_t>::max();
    for (const auto& [result, files] : root.At("results").Members()) {
      manifest.results[result] = {};
      for (const auto& [name, entry] : files.Members()) {
        manifest.results[result][name] = {entry.At("bytes").Count(kAnySize),
                                          entry.At("sha256").Text()};
      }
    }
    if (const std::optional<JsonValue> others = root.Find("others")) {
      for (std::string& name : others->Texts()) {
        manifest.others.insert(std::move(name));
      }
    }
    return manifest;
  } catch (const nlohmann::json::exception&) {
    throw InputError(Problem{.file = file.string(), .message = kNoManifest});
  }
}

namespace {

/// Returns the names of the results that may contain a file with this name. For files that belong
/// to a run, the returned names include the result `plan`, because a new plan makes the files of an
/// old run outdated.
std::vector<std::string> ResultsWith(const std::string& name) {
  std::vector<std::string> results;
  for (const ResultNames& own : AllResultNames()) {
    if (IsNameOf(own.result, name)) {
      results.push_back(own.result);
      if (own.result == run_folder::kRun && !IsNameOf(run_folder::kPlan, name)) {
        results.emplace_back(run_folder::kPlan);
      }
    }
  }
  return results;
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
  bool is_listed = manifest->others.contains(name);
  std::optional<ManifestEntry> own;
  for (const std::string& result : ResultsWith(name)) {
    const auto files = manifest->results.find(result);
    if (files == manifest->results.end()) {
      continue;
    }
    is_listed = true;
    if (const auto entry = files->second.find(name); entry != files->second.end()) {
      if (fs::file_size(file, ignored) == entry->second.size) {
        own = own ? own : MakeManifestEntry(ReadFile(file));
        if (entry->second == *own) {
          return;
        }
      }
    }
  }
  if (is_listed) {
    throw InputError(Problem{
        .file = file.string(),
        .message = "does not belong to this run: written by another (interrupted) run, or changed "
                   "since (manifest.json has the SHA-256 of its files); run it again"});
  }
}

}  // namespace trackbed
