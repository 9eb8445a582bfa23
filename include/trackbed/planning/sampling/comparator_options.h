#pragma once

namespace trackbed {

struct ComparatorOptions {
  /// Penalty added to the score of a path that collides [m], >= 0.
  double collision_penalty = 1000.0;
};

}  // namespace trackbed
