#include "src/path_files/csv_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <set>

namespace trackbed {

bool AreNumbered(const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] != std::to_string(i + 1)) {
      return false;
    }
  }
  return !names.empty();
}

std::size_t ConeCell(const std::vector<std::string>& row) {
  static const std::set<std::string> kColors{
      "blue",        "yellow",      "orange",      "bigorange", "orangebig",  "smallorange",
      "orangesmall", "largeorange", "orangelarge", "bluecone",  "yellowcone", "orangecone"};
  const auto found = std::find_if(row.begin(), row.end(), [&](const std::string& cell) {
    std::string letters = boost::to_lower_copy(cell);
    std::erase_if(letters, [](char c) { return c == '_' || c == '-' || c == ' '; });
    return kColors.contains(letters);
  });
  return static_cast<std::size_t>(found - row.begin());
}

std::string ConesInsteadOfPath() {
  return "the rows are cones beside a track, not the points of a path in order; write the middle "
         "between the cones as x_m,y_m,w_tr_right_m,w_tr_left_m, or give a file of one line";
}

std::string UnnamedColumns(const std::vector<std::string>& row) {
  constexpr std::size_t kMostShown = 12;
  std::string cells;
  for (std::size_t i = 0; i < std::min(row.size(), kMostShown); ++i) {
    cells += fmt::format("{}{}: {}", i == 0 ? "" : ", ", i + 1, row[i]);
  }
  return fmt::format(
      "no column names before the first row; give the numbers of the columns instead, such as "
      "columns.x = 1 and columns.y = 2, or add a line of names such as x_m,y_m. The first row by "
      "columns: {}{}",
      cells, row.size() > kMostShown ? ", ..." : "");
}

}  // namespace trackbed
