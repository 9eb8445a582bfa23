#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

/// Moves a failing point as near as possible to the nominal point ("shrinking").
namespace trackbed {

/// The result of a run at one point of the search space.
struct Evaluation {
  /// Robustness of the run; nullopt if the scenario is invalid.
  std::optional<double> robustness{};
  bool violated = false;
};

/// Function that evaluates a run at `point`. Returns nullopt if the allowed number of runs is used
/// up or the search was interrupted. An EvaluatePoint function must always return the same
/// evaluation for the same point.
using EvaluatePoint = std::function<std::optional<Evaluation>(const UnitPoint& point)>;

/// How far one key can be moved from its nominal value without a failure, while all other keys have
/// their nominal values.
struct SingleKeyReach {
  /// Position of the key furthest from its nominal value at which a run passed.
  double passes = 0.0;
  /// Whether `passes`, the furthest passing position, is the end of the key's range.
  bool whole_range = false;
};

/// The margins of one key: how much the key must change, compared with the counterexample, until
/// the run passes.
struct KeyMargin {
  /// Position of the key between the counterexample and the nominal value: the position nearest to
  /// the counterexample at which the run passes. While one key moves, all other keys keep the
  /// counterexample's values. The distance between `holds_to` and the position of the
  /// counterexample is at most the tolerance (or the key's step). The position `holds_to` is
  /// nullopt if the key has its nominal value in the counterexample.
  std::optional<double> holds_to{};
  /// Sensitivity of the robustness to the key: the change of the robustness over the whole range of
  /// the key. The sensitivity is extrapolated from two points, one tolerance below and one
  /// tolerance above the counterexample. The sensitivity is nullopt if the run at one of the two
  /// points has no robustness.
  std::optional<double> sensitivity{};
  /// How far the key can be lowered from its nominal value without a failure; nullopt if the
  /// nominal value is the lower end of the range.
  std::optional<SingleKeyReach> down{};
  std::optional<SingleKeyReach> up{};
};

struct ShrinkResult {
  UnitPoint point;          ///< Shrunk point; the run at this point was evaluated and fails.
  double robustness = 0.0;  ///< Robustness at `point`.
  double distance = 0.0;    ///< Distance of `point` from the nominal point.
  /// Whether the shrinking converged before the allowed number of runs was used up.
  bool complete = false;
  std::vector<KeyMargin> keys;  ///< Margins of each key; margins that are unknown are nullopt.
};

/// Moves the failing point `violation` toward the nominal point, to reduce the Euclidean distance
/// between the two points in the unit cube. Each round first bisects along the straight line to the
/// nominal point. Next, the round bisects each key separately, between the key's present value and
/// its nominal value. If the run still fails at a key's nominal value, the key is set to the
/// nominal value. The rounds are repeated until a round reduces the distance from the nominal point
/// by less than the tolerance. After the last round, the margins of each key are computed.
///
/// Guarantees: the run at the resulting point was evaluated and fails, and the point is no further
/// from the nominal point than `violation`. If the shrinking converged (`complete`), the run passes
/// after moving any single key by the tolerance toward its nominal value. If the failing points
/// form a half-space, the resulting point is the failing point nearest to the nominal point;
/// otherwise, a nearer failing point may exist. Each round needs about 10 evaluations per key with
/// a tolerance of 0.01.
///
/// Throws PreconditionError unless the tolerance is positive. Throws InternalError if the run at
/// `violation` passes or the run at the nominal point fails.
ShrinkResult Shrink(const SearchSpace& space, const UnitPoint& violation, double tolerance,
                    const EvaluatePoint& evaluate);

}  // namespace trackbed
