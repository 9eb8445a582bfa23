#pragma once

#include <filesystem>

#include "src/scenario/reader_context.h"
#include "src/scenario/yaml_file.h"
#include "src/scenario/yaml_reader.h"
#include "trackbed/core/error.h"

namespace trackbed {

/// Reads a single section of a scenario file. ReadSection throws InputError with all problems found
/// in the section.
template <typename Struct>
Struct ReadSection(const std::filesystem::path& file, const Key& key) {
  ReaderContext context{.file = file.string(), .overridden = {}, .problems = {}};
  Struct value;
  YamlReader reader(context, LoadYaml(ReadInput(file), file.string()), "");
  reader.Section(key, value);
  if (!context.problems.empty()) {
    throw InputError(context.problems);
  }
  return value;
}

}  // namespace trackbed
