#include "trackbed/analysis/json_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {

using nlohmann::ordered_json;

namespace {

/// Line and column, from 1, of a byte, counted from 1.
std::pair<int, int> Position(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte == 0 ? 0 : byte - 1);
  const std::size_t line_begin = before.rfind('\n') + 1;  // 0 on the first line
  return {1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<int>(before.size() - line_begin)};
}

/// What follows `mark` in what the library says: of "[json.exception.parse_error.101] parse error
/// at line 1, column 2: unexpected end of input" without number and place.
std::string_view After(std::string_view mark, std::string_view said) {
  const std::size_t place = said.find(mark);
  return place == std::string_view::npos ? said : said.substr(place + mark.size());
}

}  // namespace

ordered_json ParseJson(const std::filesystem::path& file) {
  constexpr std::size_t kLargest = std::size_t{16} << 20U;
  constexpr int kDeepest = 64;
  const std::string text = ReadFile(file, kLargest);
  try {
    return ordered_json::parse(text, [&](int depth, ordered_json::parse_event_t /*event*/,
                                         const ordered_json& /*parsed*/) {
      if (depth > kDeepest) {
        throw InputError(Problem{.file = file.string(),
                                 .message = fmt::format("nested deeper than {} levels", kDeepest)});
      }
      return true;
    });
  } catch (const nlohmann::json::parse_error& error) {
    const auto [line, column] = Position(text, error.byte);
    throw InputError(Problem{file.string(), line, column, "",
                             fmt::format("not JSON: {}", After(": ", error.what()))});
  }
}

void VisitJson(const std::filesystem::path& file,
               const std::function<void(const ordered_json&)>& visit, Problem problem) {
  try {
    visit(ParseJson(run_folder::RequireFile(file)));
  } catch (const nlohmann::json::exception& error) {
    problem.file = file.string();
    if (problem.message.empty()) {
      problem.message = fmt::format("not as Trackbed writes it: {}", After("] ", error.what()));
    }
    throw InputError(std::move(problem));
  }
}

std::vector<Vec2> GateCones(const ordered_json& plan) {
  std::vector<Vec2> cones;
  for (const ordered_json& gate : plan.value("gates", ordered_json::array())) {
    for (const ordered_json& cone : gate.at("cones_m")) {
      cones.emplace_back(cone.at(0).get<double>(), cone.at(1).get<double>());
    }
  }
  return cones;
}

}  // namespace trackbed
