#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {

/// State that is shared by all objects that read the same file.
struct ReaderContext {
  std::string file;
  std::vector<std::string> overridden;  // dotted keys whose values were set by the option --set
  std::vector<Problem> problems;
  // Dotted keys whose values could not be read, because the file has a problem at the key.
  std::vector<std::string> unread;
  // Returns the factor on default lengths that depend on the size of the car (car_lengths.h). The
  // function is not called if the file states all of these lengths.
  std::function<double()> car_length_scale{};
  std::optional<double> length_scale{};  // result of the first call of car_length_scale

  /// Adds a problem of a key whose value is at position `mark` of the file. If the option --set has
  /// set the key, the problem refers to --set instead of the file position.
  void AddError(const YAML::Mark& mark, const std::string& dotted, std::string message);

  /// Returns whether the value of the key was read without problems; for a list, whether every
  /// element was read.
  [[nodiscard]] bool Read(std::string_view dotted) const;

  /// Returns a hint for the key `unknown` of the section `node`. A hint is possible in two cases.
  /// If the option --set has set the method of the section, the unknown key may belong to the
  /// method that the file names. If the unknown key is a local planner or a replanner, the global
  /// planner needs a separate section. In all other cases, MethodHint returns an empty text.
  [[nodiscard]] std::string MethodHint(const std::string& section, const YAML::Node& node,
                                       const std::string& unknown) const;

  /// Sorts the collected problems by their positions in the file.
  void SortProblems();
  /// Throws InputError with all problems, sorted; does nothing if the reader has found no problems.
  void ThrowProblems();
};

}  // namespace trackbed
