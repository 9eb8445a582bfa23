#include "render/relief.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/ground_line.h"
#include "render/isolines.h"
#include "render/round_up.h"

namespace trackbed::render {
namespace {

constexpr Color kContour{0.52F, 0.40F, 0.26F};
constexpr double kContourWidth = 0.09;  // Width of the contour lines [m].
// Height of the contour lines above the ground, below all other paint [m].
constexpr double kContourHeight = 0.0015;
// Margin by which the area with contour lines extends beyond the plan and all driven paths [m].
constexpr double kMargin = 30.0;
constexpr double kMaxReliefCells = 4e4;
// height difference below which the ground is treated as level [m]
constexpr double kMinSpan = 0.02;

class Relief : public Overlay {
 public:
  explicit Relief(const OverlaySetup& setup) : recording_(setup.recording) {
    const Ground& ground = recording_.world.ground;
    if (IsFlat(ground)) {
      return;
    }
    AddHill();
    for (const Bump& bump : ground.bumps) {
      AddFeature(bump);
    }
    for (const Superelevation& side_slope : ground.side_slopes) {
      AddFeature(side_slope);
    }
  }

  [[nodiscard]] std::size_t max_shapes() const override { return PointCount(lines_); }

  void AddShapes(SceneContext& context) override {
    for (const std::vector<Point>& line : lines_) {
      AddLine(context, recording_.world, line,
              {kContour, kContourWidth * context.camera.paint_scale, kContourHeight});
    }
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    if (interval_ > 0.0) {
      legend.push_back({kContour, fmt::format("contours every {:.2g} m", interval_)});
    }
  }

 private:
  void AddHill() {
    const CameraSubject route(recording_);
    const Vec2 low(route.lowest().x - kMargin, route.lowest().y - kMargin);
    const Vec2 high(route.highest().x + kMargin, route.highest().y + kMargin);
    const Vec2 sides = high - low;
    const double step = std::max(1.0, std::sqrt(sides.x() * sides.y() / kMaxReliefCells));
    const IsolineGrid grid(low, high, step, [this](const Vec2& point) {
      return GroundHeight(recording_.world, point);
    });
    const double span = grid.highest() - grid.lowest();
    if (span < kMinSpan) {
      return;
    }
    interval_ = ContourInterval(span);
    const double first = std::ceil(grid.lowest() / interval_);
    for (double level = first; level * interval_ <= grid.highest(); level += 1.0) {
      Add(grid.At(level * interval_));
    }
  }

  /// Adds contour lines of a bump or side slope at 25 %, 50 % and 75 % of its height.
  template <typename Feature>
  void AddFeature(const Feature& feature) {
    const std::array<Vec2, 4> corners = Extent(feature).Corners();
    Vec2 low = corners[0];
    Vec2 high = corners[0];
    for (const Vec2& corner : corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    constexpr double kCells = 60.0;  // number of grid cells along the longer side of the area
    const IsolineGrid grid(low, high, (high - low).maxCoeff() / kCells,
                           [&](const Vec2& point) { return Rise(feature, point); });
    for (const double share : {0.25, 0.5, 0.75}) {
      Add(grid.At(share * grid.highest()));
    }
  }

  void Add(const std::vector<std::vector<Vec2>>& lines) {
    for (const std::vector<Vec2>& line : lines) {
      std::vector<Point> points;
      for (const Vec2& point : line) {
        points.push_back(recording_.OnGround({point.x(), point.y()}));
      }
      lines_.push_back(Thinned(points));
    }
  }

  const Recording& recording_;
  std::vector<std::vector<Point>> lines_;
  // height interval between contour lines of the whole ground [m]; 0 if the ground has no contour
  // lines
  double interval_ = 0.0;
};

}  // namespace

double ContourInterval(double span) {
  constexpr double kMaxLines = 40.0;
  return RoundedUp(span / kMaxLines);
}

OverlayEntry ReliefOverlay() {
  return MakeOverlayEntry<Relief>("relief",
                                  "contour lines of ground that is not level, and of bumps");
}

}  // namespace trackbed::render
