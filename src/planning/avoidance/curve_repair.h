#pragma once

#include <cstdint>
#include <optional>

#include "src/planning/avoidance/avoidance_curve.h"
#include "trackbed/optimize/search.h"
#include "trackbed/path/bezier.h"

/// Changes a curve past obstacles until the car can drive it.
namespace trackbed::avoidance {

struct Repair {
  BezierCurve curve;
  CurveCheck check;
  SearchResult search;
};

/// Minimizes the integral of (dkappa/ds)^2 ds along a curve, starting at the curve `guess`. The
/// variables are the positions of the control points P_3 and P_4, and the distances |P_0 P_1|, |P_1
/// P_2|, |P_5 P_6| and |P_6 P_7|. The repaired curve passes on the required side and keeps the safe
/// distance and the limits. Returns nullopt if the search finds no feasible curve.
std::optional<Repair> RepairCurve(const CurveProblem& problem, const BezierCurve& guess,
                                  const SearchOptions& search, std::uint64_t seed);

}  // namespace trackbed::avoidance
