#include "trackbed/path_files/pose_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cctype>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "trackbed/path_files/path_map.h"

// A name is compared by its words: they are separated by other characters than letters and digits,
// and by a capital letter behind a small one ("positionX").
namespace trackbed {
namespace {

/// Words before a usual name that do not change its meaning.
const std::set<std::string>& PoseWords() {
  static const std::set<std::string> words{
      "pose",  "poses",   "position", "pos",   "odom",    "odometry",   "point",  "points",
      "utm",   "map",     "location", "world", "local",   "global",     "ego",    "car",
      "robot", "vehicle", "state",    "field", "msg",     "waypoint",   "wp",     "waypoints",
      "path",  "traj",    "data",     "gt",    "current", "trajectory", "center", "cog"};
  return words;
}

bool IsWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

std::vector<std::string> Words(std::string_view name) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool is_new = i > 0 && std::isupper(static_cast<unsigned char>(c)) != 0 &&
                        std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
    if ((is_new || !IsWordCharacter(c)) && !words.back().empty()) {
      words.emplace_back();
    }
    if (IsWordCharacter(c)) {
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  if (words.back().empty()) {
    words.pop_back();
  }
  return words;
}

/// A column name, split into its words for a pose (at both ends) and the remaining words.
struct ReducedName {
  std::string pose;  // The words for a pose.
  std::string rest;  // The other words.
};

ReducedName Reduce(std::string_view name) {
  const std::vector<std::string> words = Words(name);
  const auto is_other = [](const std::string& word) { return PoseWords().count(word) == 0; };
  const auto first = std::find_if(words.begin(), words.end(), is_other);
  const auto last =
      std::find_if(words.rbegin(), std::make_reverse_iterator(first), is_other).base();
  return {
      fmt::format("{}_{}", fmt::join(words.begin(), first, "_"), fmt::join(last, words.end(), "_")),
      fmt::format("{}", fmt::join(first, last, "_"))};
}

/// Returns less usual names of x and y, whose unit is the meter.
std::vector<std::string> OtherNames(std::string_view quantity) {
  return quantity == "x"   ? std::vector<std::string>{"px", "east", "east_m"}
         : quantity == "y" ? std::vector<std::string>{"py", "north", "north_m"}
                           : std::vector<std::string>{};
}

/// Returns the columns of a quantity. The map's key is the pose words that surround the quantity's
/// usual name in the column's name. A header may repeat a name; the reader refuses this.
std::map<std::string, UsualColumn> ColumnsByPose(const std::vector<std::string>& names,
                                                 std::string_view quantity) {
  std::map<std::string, UsualColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const ReducedName reduced = Reduce(names[i]);
    for (const PathColumnName& own : PathColumnNames(quantity)) {
      if (reduced.rest == fmt::format("{}", fmt::join(Words(own.name), "_"))) {
        columns.emplace(reduced.pose, UsualColumn{i, own.unit});
      }
    }
    const std::vector<std::string> others = OtherNames(quantity);
    if (std::find(others.begin(), others.end(), reduced.rest) != others.end()) {
      columns.emplace(reduced.pose, UsualColumn{i, "m"});
    }
  }
  return columns;
}

}  // namespace

std::optional<UsualColumn> FindUsualColumn(const std::vector<std::string>& names,
                                           std::string_view quantity) {
  for (const PathColumnName& own : PathColumnNames(quantity)) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (boost::iequals(names[i], own.name)) {
        return UsualColumn{i, own.unit};
      }
    }
  }
  return std::nullopt;
}

PoseColumns FindPoseColumns(const std::vector<std::string>& names) {
  PoseColumns found;
  const auto ys = ColumnsByPose(names, "y");
  const auto yaws = ColumnsByPose(names, "yaw");
  for (const auto& [pose, x] : ColumnsByPose(names, "x")) {
    const auto y = ys.find(pose);
    if (y == ys.end()) {
      continue;
    }
    found.choices.push_back(names[x.index]);
    found.x = x;
    found.y = y->second;
    const auto yaw = yaws.find(pose);
    found.yaw = yaw == yaws.end() ? std::nullopt : std::optional(yaw->second);
  }
  if (found.choices.size() > 1) {
    return {.x = {}, .y = {}, .yaw = {}, .choices = std::move(found.choices)};
  }
  found.choices.clear();
  return found;
}

}  // namespace trackbed
