#include "trackbed/scenario/disturbances.h"

#include <algorithm>

namespace trackbed {

std::optional<double> DisturbedUntil(const Disturbances& disturbances, const Wind& wind,
                                     double before) {
  std::optional<double> last;
  const auto take_in = [&](double end) {
    if (end <= before) {
      last = std::max(last.value_or(end), end);
    }
  };
  for (const Kick& kick : disturbances.kicks) {
    take_in(kick.at + (kick.impulse ? kick.duration.value_or(kKickDuration) : 0.0));
  }
  for (const Gust& gust : wind.gusts) {
    if (gust.duration) {
      take_in(gust.from + *gust.duration);
    }
  }
  return last;
}

}  // namespace trackbed
