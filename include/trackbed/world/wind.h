#pragma once

#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"

/// Wind is the velocity of the air over the ground: where it blows to, not where it comes from.
namespace trackbed {

enum class GustShape {
  kOneMinusCosine,  ///< (1 - cos(2 pi t / T))/2, from 0 to 1 at half time and back
  kStep,            ///< 1 from the first moment to the last
};

/// Wind that comes and goes, everywhere or on one stretch.
struct Gust {
  Vec2 velocity = Vec2::Zero();    ///< at its strongest, on top of all other wind [m/s]
  double from = 0.0;               ///< [s]
  std::optional<double> duration;  ///< [s]; none: it never ends, which only a step can
  GustShape shape = GustShape::kOneMinusCosine;
  std::optional<OrientedBox> area;  ///< where it blows, with sharp edges; none: everywhere
};

/// All the wind there is: the same everywhere and always, and gusts on top of it.
struct Wind {
  Vec2 velocity = Vec2::Zero();  ///< [m/s]
  std::vector<Gust> gusts{};
};

/// Share of its velocity that a gust has at `time`, in [0, 1].
double GustStrength(const Gust& gust, double time);

/// Velocity of the air at a place and moment [m/s]. Cost O(gusts).
Vec2 WindAt(const Wind& wind, const Vec2& point_W, double time);

/// Whether there is ever any wind.
bool IsCalm(const Wind& wind);

}  // namespace trackbed
