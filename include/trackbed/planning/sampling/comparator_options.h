#pragma once

namespace trackbed {

struct ComparatorOptions {
  /// Penalty that is added to the score of a path that collides with an obstacle [m], >= 0.
  double collision_penalty = 1000.0;
};

}  // namespace trackbed
