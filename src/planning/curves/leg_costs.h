#pragma once

#include <array>
#include <map>
#include <vector>

#include "src/planning/curves/clothoid_turns.h"

/// Costs of legs of continuous curvature that several routes share.
namespace trackbed {

/// The known cost of the cheapest leg between two states, or a lower bound of the cost.
struct LegCost {
  double cost = kNoCurve;  ///< Cost of the leg; infinite: unknown, or the leg is blocked.
  double least = 0.0;      ///< Lower bound of an unknown cost; infinite: the leg is blocked.
};

/// Keeps the costs of legs by their values, so that a planner that plans a route several times
/// computes each leg only once. All routes must have the same car, obstacles and options. The
/// memory grows by 2 kB for each leg with other poses.
class LegCosts {
 public:
  /// Both poses of a leg, and all other inputs of the leg's cost except the curvatures.
  using Key = std::array<double, 12>;

  /// Returns the costs for `count` pairs of curvatures at the ends of a leg.
  std::vector<LegCost>& Of(const Key& key, std::size_t count) {
    std::vector<LegCost>& costs = costs_[key];
    costs.resize(count);
    return costs;
  }

 private:
  std::map<Key, std::vector<LegCost>> costs_;
};

}  // namespace trackbed
