#pragma once

#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"

/// The wind is the velocity of the air over the ground; the velocity vector points in the direction
/// in which the air moves.
namespace trackbed {

enum class GustShape {
  /// Cosine gust: the strength is (1 - cos(2 pi t / T))/2, which is 0 at both ends of the duration
  /// T and 1 in the middle.
  kOneMinusCosine,
  kStep,  ///< Step gust: the strength is 1 over the whole duration.
};

/// A gust of wind, everywhere or in one area.
struct Gust {
  /// Peak velocity of the gust, which is added to all other wind [m/s].
  Vec2 velocity = Vec2::Zero();
  double from = 0.0;  ///< Start time [s].
  /// Duration of the gust [s]; nullopt: unlimited, which is only allowed for the shape kStep.
  std::optional<double> duration;
  GustShape shape = GustShape::kOneMinusCosine;
  /// Area of the gust, with sharp edges; nullopt: the gust is everywhere.
  std::optional<OrientedBox> area;
};

/// A constant and uniform wind, to which gusts are added.
struct Wind {
  Vec2 velocity = Vec2::Zero();  ///< Velocity of the constant wind [m/s].
  std::vector<Gust> gusts{};
};

/// Returns the strength of a gust at `time`, as a fraction of the gust's peak velocity in [0, 1].
double GustStrength(const Gust& gust, double time);

/// Returns the velocity of the air at a point and time [m/s]. The run time of WindAt is
/// proportional to the number of gusts.
Vec2 WindAt(const Wind& wind, const Vec2& point_W, double time);

/// Whether the wind is zero everywhere and at all times.
bool IsCalm(const Wind& wind);

}  // namespace trackbed
