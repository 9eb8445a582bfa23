#include "trackbed/scenario/moving_ai_instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"
#include "trackbed/scenario/map_file.h"

namespace trackbed {
namespace {

/// Splits a line of an instance file at blanks and tabs.
std::vector<std::string_view> Fields(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> fields;
  for (std::size_t from = line.find_first_not_of(kBlanks); from != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, from), line.size());
    fields.push_back(line.substr(from, end - from));
    from = line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

template <typename T>
bool Parse(std::string_view field, T& value) {
  const auto [after, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && after == field.data() + field.size();
}

/// Parses one line of a MovingAI instance file. Returns an error message if the line is invalid,
/// else an empty string.
std::string ParseInstance(std::string_view line, MovingAiInstance& instance) {
  const std::vector<std::string_view> fields = Fields(line);
  constexpr std::size_t kCount = 9;
  if (fields.size() != kCount) {
    return fmt::format(
        "{} fields; must be {}: bucket, map, its width and height, x and y of start "
        "and goal, length",
        fields.size(), kCount);
  }
  instance.map = fields[1];
  int start_y = 0;
  int goal_y = 0;
  const std::array numbers{std::pair{std::size_t{0}, &instance.bucket},
                           std::pair{std::size_t{2}, &instance.columns},
                           std::pair{std::size_t{3}, &instance.rows},
                           std::pair{std::size_t{4}, &instance.start_column},
                           std::pair{std::size_t{5}, &start_y},
                           std::pair{std::size_t{6}, &instance.goal_column},
                           std::pair{std::size_t{7}, &goal_y}};
  for (const auto& [field, value] : numbers) {
    if (!Parse(fields[field], *value)) {
      return fmt::format("field {}: '{:.40}' is no whole number", field + 1, fields[field]);
    }
  }
  if (!Parse(fields.back(), instance.length) || !std::isfinite(instance.length) ||
      instance.length < 0.0) {
    return fmt::format("field {}: '{:.40}' is no length", kCount, fields.back());
  }
  const auto is_on_map = [&](int column, int y) {
    return column >= 0 && y >= 0 && column < instance.columns && y < instance.rows;
  };
  if (!is_on_map(instance.start_column, start_y) || !is_on_map(instance.goal_column, goal_y)) {
    return fmt::format("start ({}, {}) or goal ({}, {}) is not on the map of {} x {} cells",
                       instance.start_column, start_y, instance.goal_column, goal_y,
                       instance.columns, instance.rows);
  }
  instance.start_row = instance.rows - 1 - start_y;
  instance.goal_row = instance.rows - 1 - goal_y;
  return "";
}

}  // namespace

std::vector<MovingAiInstance> ReadMovingAiInstances(const std::filesystem::path& file) {
  std::string text;
  try {
    text = ReadFile(file, kMaxMapFileBytes);
  } catch (const RunError& error) {
    throw InputError(Problem{.message = error.what()});
  }
  std::istringstream lines(text);
  std::vector<MovingAiInstance> instances;
  ProblemList problems;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::vector<std::string_view> fields = Fields(line);
    if (number == 1) {
      if (fields.size() != 2 || fields[0] != "version" ||
          (fields[1] != "1" && fields[1] != "1.0")) {
        throw InputError(
            Problem{.file = file.string(),
                    .line = 1,
                    .message = fmt::format("expected 'version 1', found '{:.40}'", line)});
      }
    } else if (!fields.empty()) {
      MovingAiInstance instance{.line = number};
      if (std::string problem = ParseInstance(line, instance); !problem.empty()) {
        problems.Add({.file = file.string(), .line = number, .message = std::move(problem)});
      } else {
        instances.push_back(std::move(instance));
      }
    }
  }
  if (number == 0) {
    problems.Add({.file = file.string(), .message = "is empty; expected 'version 1'"});
  }
  problems.ThrowIfAny();
  return instances;
}

}  // namespace trackbed
