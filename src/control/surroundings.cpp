#include "trackbed/control/surroundings.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

EdgeDistances PathEdges::At(double station) const {
  const double place =
      std::clamp(station / spacing, 0.0, static_cast<double>(distances.size() - 1));
  const auto before = static_cast<std::size_t>(place);
  const EdgeDistances& a = distances[before];
  const EdgeDistances& b = distances[std::min(before + 1, distances.size() - 1)];
  const double share = place - std::floor(place);
  return {std::lerp(a.left, b.left, share), std::lerp(a.right, b.right, share)};
}

}  // namespace trackbed
