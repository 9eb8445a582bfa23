#include "trackbed/world/wind.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"

namespace trackbed {

double GustStrength(const Gust& gust, double time) {
  const double since = time - gust.from;
  if (since < 0.0 || (gust.duration && since > *gust.duration)) {
    return 0.0;
  }
  if (gust.shape == GustShape::kStep || !gust.duration) {
    return 1.0;
  }
  return 0.5 * (1.0 - std::cos(2.0 * kPi * since / *gust.duration));
}

Vec2 WindAt(const Wind& wind, const Vec2& point_W, double time) {
  Vec2 sum = wind.velocity;
  for (const Gust& gust : wind.gusts) {
    if (!gust.area || Contains(*gust.area, point_W)) {
      sum += GustStrength(gust, time) * gust.velocity;
    }
  }
  return sum;
}

bool IsCalm(const Wind& wind) {
  return wind.velocity.isZero(0.0) &&
         std::all_of(wind.gusts.begin(), wind.gusts.end(),
                     [](const Gust& gust) { return gust.velocity.isZero(0.0); });
}

}  // namespace trackbed
