#pragma once

namespace trackbed {

struct ComparatorOptions {
  double collision_penalty = 1000.0;  ///< [m], >= 0: added to a path that collides
};

}  // namespace trackbed
