#include "render/wind_arrows.h"

#include <algorithm>
#include <cmath>

#include "render/ribbon.h"
#include "render/scene.h"

namespace trackbed::render {
namespace {

constexpr double kSpacing = 5.0;  // [m]
constexpr int kHalfCount = 4;     // of places from the middle to each side: 81 in all
constexpr double kHeight = 0.004;
constexpr double kWidth = 0.12;
constexpr double kLeast = 0.5;  // [m/s]; reads as calm
constexpr double kPerSpeed = 1.0 / 3.0;
constexpr double kShortest = 0.6;  // [m]; a head alone
constexpr double kLongest = 4.0;   // [m]; the next one begins at 5

void AddArrow(mjvScene& scene, const Recording& recording, const Vec2& middle, const Vec2& wind,
              double scale) {
  const double speed = wind.norm();
  const Vec2 along = wind / speed;
  const Vec2 across(-along.y(), along.x());
  const double half = 0.5 * scale * std::clamp(kPerSpeed * speed, kShortest, kLongest);
  const double head = 0.42 * scale;
  const RibbonStyle style{kWindColor, kWidth * scale, kHeight};
  const Eigen::Vector3d normal = GroundNormal(recording.world, middle);
  const auto ground = [&](const Vec2& point) { return recording.OnGround({point.x(), point.y()}); };
  const Vec2 tip = middle + half * along;
  AddRibbonPiece(scene, ground(middle - half * along), ground(tip), style, normal);
  for (const double side : {-0.7, 0.7}) {
    AddRibbonPiece(scene, ground(tip - head * along + side * head * across), ground(tip), style,
                   normal);
  }
}

}  // namespace

void AddWindArrows(mjvScene& scene, const Recording& recording, double time,
                   const CameraPose& camera) {
  const double spacing = kSpacing * camera.paint_scale;
  const double first_x = std::round(camera.target_x / spacing);
  const double first_y = std::round(camera.target_y / spacing);
  for (int row = -kHalfCount; row <= kHalfCount; ++row) {
    for (int column = -kHalfCount; column <= kHalfCount; ++column) {
      const Vec2 place(spacing * (first_x + column), spacing * (first_y + row));
      const Vec2 wind = WindAt(recording.world, place, time);
      if (wind.norm() >= kLeast) {
        AddArrow(scene, recording, place, wind, camera.paint_scale);
      }
    }
  }
}

}  // namespace trackbed::render
