#include "render/wind_arrows.h"

#include <algorithm>
#include <cmath>

#include "render/ground_line.h"
#include "render/palette.h"

namespace trackbed::render {
namespace {

constexpr double kGustWidth = 0.16;
constexpr double kGustHeight = 0.006;

constexpr double kSpacing = 5.0;  // Spacing of the wind arrows on the ground [m].
// Number of arrows from the middle arrow to each side; 81 arrows in total.
constexpr int kHalfCount = 4;
constexpr double kArrowHeight = 0.004;
constexpr double kArrowWidth = 0.12;
constexpr double kMinWindSpeed = 0.5;  // wind speed below which no arrow is drawn [m/s]
constexpr double kPerSpeed = 1.0 / 3.0;
// Minimum length of an arrow [m], at which only the arrow's head is visible.
constexpr double kMinArrowLength = 0.6;
// Maximum length of an arrow [m]; below the spacing of 5 m.
constexpr double kMaxArrowLength = 4.0;

void AddArrow(mjvScene& scene, const Recording& recording, const Vec2& middle, const Vec2& wind,
              double scale) {
  const double speed = wind.norm();
  const Vec2 along = wind / speed;
  const Vec2 across(-along.y(), along.x());
  const double half = 0.5 * scale * std::clamp(kPerSpeed * speed, kMinArrowLength, kMaxArrowLength);
  const double head = 0.42 * scale;
  const RibbonStyle style{kWindColor, kArrowWidth * scale, kArrowHeight};
  const Eigen::Vector3d normal = GroundNormal(recording.world, middle);
  const auto ground = [&](const Vec2& point) { return recording.OnGround({point.x(), point.y()}); };
  const Vec2 tip = middle + half * along;
  AddRibbonPiece(scene, ground(middle - half * along), ground(tip), style, normal);
  for (const double side : {-0.7, 0.7}) {
    AddRibbonPiece(scene, ground(tip - head * along + side * head * across), ground(tip), style,
                   normal);
  }
}

/// The outline of an area in which there is a gust.
struct GustLine {
  Gust gust;
  std::vector<Point> points;
};

std::vector<GustLine> GustLines(const Recording& recording) {
  std::vector<GustLine> lines;
  for (const Gust& gust : recording.world.wind.gusts) {
    if (gust.area) {
      lines.push_back({gust, Thinned(Outline(recording, gust.area->Corners()))});
    }
  }
  return lines;
}

class WindArrows : public Overlay {
 public:
  explicit WindArrows(const OverlaySetup& setup)
      : recording_(setup.recording), gusts_(GustLines(recording_)) {}

  [[nodiscard]] std::size_t max_shapes() const override {
    constexpr std::size_t kSide = 2 * kHalfCount + 1;
    std::size_t sum = 3 * kSide * kSide;
    for (const GustLine& line : gusts_) {
      sum += line.points.size();
    }
    return sum;
  }

  void AddShapes(SceneContext& context) override {
    const CameraPose& camera = context.camera;
    for (const GustLine& line : gusts_) {
      if (GustStrength(line.gust, context.time) != 0.0) {
        AddLine(context, recording_.world, line.points,
                {kGustColor, kGustWidth * camera.paint_scale, kGustHeight});
      }
    }
    const double spacing = kSpacing * camera.paint_scale;
    const double first_x = std::round(camera.target_x / spacing);
    const double first_y = std::round(camera.target_y / spacing);
    for (int row = -kHalfCount; row <= kHalfCount; ++row) {
      for (int column = -kHalfCount; column <= kHalfCount; ++column) {
        const Vec2 place(spacing * (first_x + column), spacing * (first_y + row));
        const Vec2 wind = WindAt(recording_.world, place, context.time);
        if (wind.norm() >= kMinWindSpeed) {
          AddArrow(context.scene, recording_, place, wind, camera.paint_scale);
        }
      }
    }
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    if (!IsCalm(recording_.world.wind)) {
      legend.push_back({kWindColor, "wind"});
    }
    if (!gusts_.empty()) {
      legend.push_back({.color = kGustColor, .text = "gust", .symbol = LegendSymbol::kOutline});
    }
  }

 private:
  const Recording& recording_;
  std::vector<GustLine> gusts_;
};

}  // namespace

OverlayEntry WindOverlay() {
  return MakeOverlayEntry<WindArrows>("wind",
                                      "wind arrows on the ground, and outlines of gust areas");
}

}  // namespace trackbed::render
