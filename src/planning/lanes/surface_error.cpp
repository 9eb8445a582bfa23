#include "src/planning/lanes/surface_error.h"

#include <fmt/format.h>

#include <cmath>

namespace trackbed {
namespace {

constexpr double kMaxSlope = 1.0;  // Largest slope of a lane, equal to that of bumps in the ground.

/// Returns an error message if the profile of a road is too steep on a drivable lane at this
/// station; otherwise an empty text.
std::string ProfileError(const Road& road, double s) {
  if (road.shape.empty()) {
    return "";
  }
  const std::size_t section = road.SectionAt(s);
  for (const Lane& lane : road.sections[section].lanes) {
    if (!IsDrivable(lane)) {
      continue;
    }
    const LaneBorders borders = LaneBordersAt(road, section, lane.id, s, s);
    constexpr double kSpacing = 0.25;  // [m]
    const double parts = std::max(1.0, std::ceil(borders.Width() / kSpacing));
    double before = ShapeHeight(road, s, borders.inner.value);
    for (double i = 1.0; i <= parts; i += 1.0) {
      const double height =
          ShapeHeight(road, s, std::lerp(borders.inner.value, borders.outer.value, i / parts));
      const double slope = std::abs(height - before) * parts / borders.Width();
      if (!(slope <= kMaxSlope) && borders.Width() > 0.0) {
        return fmt::format(
            "road {} at s = {:.4g} m has a slope of {:.3g} across lane {}; must be at most 45 "
            "degrees steep",
            road.id, s, slope, lane.id);
      }
      before = height;
    }
  }
  return "";
}

}  // namespace

std::string SurfaceError(const Road& road, double s) {
  const CubicValue height = road.elevation.At(s);
  const double roll = road.superelevation.At(s).value;
  if (!(std::abs(height.slope) <= kMaxSlope && std::abs(std::tan(roll)) <= kMaxSlope &&
        std::cos(roll) > 0.0)) {
    return fmt::format(
        "road {} at s = {:.4g} m has a grade of {:.3g} and a superelevation of {:.3g} rad; must be "
        "at most 45 degrees steep",
        road.id, s, height.slope, roll);
  }
  constexpr double kMaxHeight = 1e4;  // [m]
  const double z = height.value + ShapeHeight(road, s, 0.0);
  if (!(std::abs(z) <= kMaxHeight)) {
    return fmt::format(
        "road {} at s = {:.4g} m is {:.3g} m high; must be at least {} and at most {}", road.id, s,
        z, -kMaxHeight, kMaxHeight);
  }
  constexpr double kMaxLaneBorder = 50.0;  // [m]
  const std::size_t section = road.SectionAt(s);
  for (const Lane& lane : road.sections[section].lanes) {
    const double border = LaneBordersAt(road, section, lane.id, s, s).outer.value;
    if (IsDrivable(lane) && !(std::abs(border) <= kMaxLaneBorder)) {
      return fmt::format(
          "lane {} of road {} reaches {:.4g} m from the reference line at s = {:.4g} m; must be at "
          "most {} m on roads that are not level",
          lane.id, road.id, std::abs(border), s, kMaxLaneBorder);
    }
  }
  return ProfileError(road, s);
}

}  // namespace trackbed
