#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/scenario/reader_context.h"
#include "trackbed/scenario/study.h"

/// Reads the sections of a study that set keys of the study's scenario.
namespace trackbed {

/// Returns the setting of a key, with the value as YAML text.
Setting ParseSetting(const std::string& key, const YAML::Node& value);

using ReadEntry =
    std::function<void(const YAML::Node& key, const YAML::Node& value, const std::string& dotted)>;

/// Calls `read` with each key of a section that contains scenario keys, and with the value of the
/// key.
void ForEachKey(ReaderContext& context, const YAML::Node& node, const std::string& section,
                const ReadEntry& read);

/// Reports a problem at the key `from` unless from < to.
void CheckEnds(ReaderContext& context, const YAML::Node& node, const std::string& dotted,
               double from, double to);

/// Folders from which a study may read tables.
struct StudyFolders {
  std::filesystem::path own;
  const std::vector<std::filesystem::path>& others;
};

/// Reads an entry of `vary`: a list of values, a range, or a distribution.
Variation ReadVariation(ReaderContext& context, const StudyFolders& folders, const std::string& key,
                        const YAML::Node& node, const std::string& dotted);

}  // namespace trackbed
