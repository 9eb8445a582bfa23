#include "src/planning/grid/pose_search.h"

#include <algorithm>
#include <cmath>

#include "src/planning/grid/arc_search.h"
#include "src/planning/grid/clothoid_search.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/grid/astar.h"

namespace trackbed {
namespace {

/// Largest ratio of the length of a path on the eight-neighbor grid to the length of the straight
/// line: 1/cos(pi/8).
constexpr double kOctileOverStraight = 1.0823922002923940;

}  // namespace

GridDistance::GridDistance(std::shared_ptr<const OccupancyGrid> grid, const Vec2& target)
    : grid_(std::move(grid)),
      distances_(DistancesTo(*grid_, static_cast<std::size_t>(grid_->CellAt(target)))) {}

double GridDistance::LowerBound(const Vec2& point) const {
  const int cell = grid_->CellAt(point);
  if (cell < 0) {
    return std::numeric_limits<double>::infinity();
  }
  // Points of two cells may be closer together than the cells' centers, by up to the diagonal of a
  // cell.
  const double steps = distances_[static_cast<std::size_t>(cell)] / kOctileOverStraight;
  return grid_->cell * std::max(steps - std::sqrt(2.0), 0.0);
}

Resolution Resolution::WithBins(double cell, int headings, double radius) {
  return {.cell = cell,
          .headings = headings,
          .step = std::max(1.5 * cell, 2.0 * kPi * radius / headings)};
}

std::unique_ptr<PoseSearch> MakePoseSearch(const SearchSpace& space, const Resolution& resolution,
                                           SearchSide side,
                                           std::shared_ptr<const GridDistance> left) {
  const CurveCurvature curvature = space.options.curvature;
  return curvature == CurveCurvature::kAuto || curvature == CurveCurvature::kSteps
             ? MakeArcSearch(space, resolution, side, std::move(left))
             : MakeClothoidSearch(space, resolution, side, std::move(left));
}

}  // namespace trackbed
