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
  // Returns the factor on default lengths that follow from the size of the car (car_lengths.h); not
  // called if the file gives all of these lengths.
  std::function<double()> car_length_scale{};
  std::optional<double> length_scale{};  // result of the first call of car_length_scale

  /// Adds a problem of a key whose value is at position `mark` of the file. If the option --set has
  /// set the key, the problem refers to --set instead of the file position.
  void AddError(const YAML::Mark& mark, const std::string& dotted, std::string message);

  /// Returns whether the key was read; for a list, whether every element was read.
  [[nodiscard]] bool Read(std::string_view dotted) const;

  /// Returns a hint for the key `unknown` of the section `node`. There are two reasons for a hint
  /// about an unknown key. If the option --set has set the method of the section, the key may
  /// belong to the method that the file names. If the unknown key is a local planner or a
  /// replanner, the global planner needs a separate section. Returns an empty text if neither
  /// reason applies.
  [[nodiscard]] std::string MethodHint(const std::string& section, const YAML::Node& node,
                                       const std::string& unknown) const;

  /// Sorts the problems by their positions in the file.
  void SortProblems();
  /// Throws InputError with the sorted problems; does nothing if there are no problems.
  void ThrowProblems();
};

}  // namespace trackbed
