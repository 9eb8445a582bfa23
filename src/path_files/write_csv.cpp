#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/path_files/path_file.h"

// Writes the points of a path as a CSV file.
namespace trackbed {

std::string PathCsv(const PathPoints& points) {
  std::vector<std::string> columns{"x_m", "y_m"};
  std::vector<const std::vector<double>*> lists;
  const auto add = [&](const char* name, const std::vector<double>& list) {
    if (!list.empty()) {
      columns.emplace_back(name);
      lists.push_back(&list);
    }
  };
  add("yaw_rad", points.yaw);
  add("curvature_radpm", points.curvature);
  add("speed_mps", points.speed);
  add("t_s", points.time);
  if (!points.direction.empty()) {
    columns.emplace_back("direction");
  }
  Table table(columns);
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    std::vector<double> row{points.points[i].x(), points.points[i].y()};
    for (const std::vector<double>* list : lists) {
      row.push_back((*list)[i]);
    }
    if (!points.direction.empty()) {
      row.push_back(points.direction[i]);
    }
    table.AddRow(row);
  }
  return table.ToCsv();
}

}  // namespace trackbed
