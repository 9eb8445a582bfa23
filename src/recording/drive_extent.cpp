#include "src/recording/drive_extent.h"

#include <fmt/format.h>

namespace trackbed {

std::string ExtentProblem(const std::vector<Vec2>& positions,
                          const std::function<std::string(std::size_t row)>& row_name) {
  if (positions.size() < 2) {
    return "";
  }
  Vec2 least = positions.front();
  Vec2 most = least;
  std::size_t after = 1;
  double farthest = 0.0;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    least = least.cwiseMin(positions[i]);
    most = most.cwiseMax(positions[i]);
    const double jump = (positions[i] - positions[i - 1]).cwiseAbs().maxCoeff();
    if (jump > farthest) {
      farthest = jump;
      after = i;
    }
  }
  const double extent = (most - least).maxCoeff();
  if (!(extent > kMaxDriveExtent)) {
    return "";
  }
  return fmt::format(
      "the positions extend over {:.10g} m; must extend over at most {:.0f} m: the farthest jump, "
      "of {:.10g} m, is from ({:g}, {:g}) at {} to ({:g}, {:g}) at {}; is a coordinate wrong?",
      extent, kMaxDriveExtent, farthest, positions[after - 1].x(), positions[after - 1].y(),
      row_name(after - 1), positions[after].x(), positions[after].y(), row_name(after));
}

}  // namespace trackbed
