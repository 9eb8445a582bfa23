#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "src/scenario/reader_context.h"
#include "trackbed/scenario/study.h"

/// Functions that read the sections of a study file in which keys of a scenario get values.
namespace trackbed {

/// Returns a setting (key and value) of a study run; the value is stored as YAML text.
Setting ParseSetting(const std::string& key, const YAML::Node& value);

using ReadEntry =
    std::function<void(const YAML::Node& key, const YAML::Node& value, const std::string& dotted)>;

/// Calls `read` with each key and value of a section of a study file; the keys of the section are
/// keys of a scenario.
void ForEachKey(ReaderContext& context, const YAML::Node& node, const std::string& section,
                const ReadEntry& read);

/// Checks the keys `from` and `to` of a section: reports a problem at the key `from` unless from <
/// to.
void CheckEnds(ReaderContext& context, const YAML::Node& node, const std::string& dotted,
               double from, double to);

/// Folders from which a study may read tables.
struct StudyFolders {
  std::filesystem::path own;
  const std::vector<std::filesystem::path>& others;
};

/// Reads an entry of the section `vary` of a study: a list of values, a range, or a distribution.
Variation ReadVariation(ReaderContext& context, const StudyFolders& folders, const std::string& key,
                        const YAML::Node& node, const std::string& dotted);

}  // namespace trackbed
