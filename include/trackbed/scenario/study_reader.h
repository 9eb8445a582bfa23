#pragma once

#include <filesystem>
#include <vector>

#include "trackbed/scenario/study.h"

/// Reads study files.
namespace trackbed {

/// Returns true if the file has the key `scenario`, which studies have but scenarios do not.
/// Returns false if the file cannot be read.
bool IsStudy(const std::filesystem::path& file);

/// Reads a study and the text of the study's scenario, and rejects any invalid key. Throws
/// InputError, which lists **every** problem of the study's keys, including keys that overwrite
/// each other.
Study ReadStudy(const std::filesystem::path& file, const std::vector<Override>& overrides = {},
                const MetricPaths& metrics = {},
                const std::vector<std::filesystem::path>& asset_folders = {});

}  // namespace trackbed
