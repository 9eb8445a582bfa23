#pragma once

#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"

/// Wind is the velocity of the air over the ground, in the direction toward which it blows.
namespace trackbed {

enum class GustShape {
  kOneMinusCosine,  ///< (1 - cos(2 pi t / T))/2, from 0 to 1 at half time and back to 0.
  kStep,            ///< Constant 1 over the whole duration.
};

/// A gust, everywhere or in one area.
struct Gust {
  Vec2 velocity = Vec2::Zero();    ///< Peak velocity, added to all other wind [m/s].
  double from = 0.0;               ///< Start time [s].
  std::optional<double> duration;  ///< Duration [s]; nullopt: unlimited, which only a step may be.
  GustShape shape = GustShape::kOneMinusCosine;
  std::optional<OrientedBox> area;  ///< Area of the gust, with sharp edges; none: everywhere.
};

/// Constant, uniform wind, and gusts added to it.
struct Wind {
  Vec2 velocity = Vec2::Zero();  ///< Velocity of the air [m/s].
  std::vector<Gust> gusts{};
};

/// The fraction, in [0, 1], of its peak velocity that a gust has at `time`.
double GustStrength(const Gust& gust, double time);

/// Velocity of the air at a point and time [m/s]. Cost O(gusts).
Vec2 WindAt(const Wind& wind, const Vec2& point_W, double time);

/// Whether there is no wind at any time.
bool IsCalm(const Wind& wind);

}  // namespace trackbed
