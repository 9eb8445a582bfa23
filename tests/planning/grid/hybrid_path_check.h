#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Checks the end and the curvatures of the path. Checks every 2 cm, independently of the planner's
/// code, that the footprint keeps the safe distance.
inline void ExpectGood(const HybridAStarProblem& problem, const HybridAStarOptions& options,
                       const HybridAStarResult& result) {
  ASSERT_TRUE(result.ok()) << result.reason;
  const Path path(problem.start, result.segments);
  EXPECT_LE(Apart(path.At(path.length()).pose, problem.goal), Tolerance(1e-9));
  const double radius = options.radius.value_or(1.1 * ReferenceCar().min_turning_radius());
  for (const Segment& segment : result.segments) {
    EXPECT_LE(std::abs(segment.curvature), 1.0 / radius + Tolerance(1e-12));
  }
  // The farthest corner moves by up to (1 + 3.7/5.6) m per meter of the path, 1.7 cm within half a
  // step of 2 cm.
  const double missed = Tolerance(0.017);
  for (double s = 0.0; s <= path.length(); s += 0.02) {
    const OrientedBox footprint = FootprintAt(ReferenceCar(), path.At(s).pose);
    for (const OrientedBox& box : problem.obstacles) {
      ASSERT_GE(Separation(footprint, box), options.safe_distance - missed) << "at " << s;
    }
  }
}

}  // namespace trackbed
