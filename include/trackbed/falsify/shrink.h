#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

/// Shrinks a violation toward the nominal point.
namespace trackbed {

/// The result of a run at a point.
struct Evaluation {
  std::optional<double> robustness{};  ///< none if there is no such scenario
  bool violated = false;
};

/// Evaluates a point. None if it may not be run: the budget is used up, or the search was
/// interrupted. The same point must give the same evaluation each time.
using EvaluatePoint = std::function<std::optional<Evaluation>(const UnitPoint& point)>;

/// How far a key can be moved alone, with all others at their nominal values.
struct SingleKeyReach {
  double passes = 0.0;       ///< the outermost position that passed, toward the end of the range
  bool whole_range = false;  ///< that position is the end itself
};

/// A key at the counterexample.
struct KeyMargin {
  /// The position nearest to the counterexample's, toward the nominal one and at most a tolerance
  /// (or the key's step) away, that passes with all other keys at the counterexample's values. None
  /// for a key at its nominal value.
  std::optional<double> holds_to{};
  /// Change of the robustness over the whole range of the key, extrapolated from points a tolerance
  /// to either side; none if one of them has no robustness.
  std::optional<double> sensitivity{};
  std::optional<SingleKeyReach> down{};  ///< none for a key whose nominal value is the range's end
  std::optional<SingleKeyReach> up{};
};

struct ShrinkResult {
  UnitPoint point;              ///< violates; was evaluated
  double robustness = 0.0;      ///< at `point`
  double distance = 0.0;        ///< from the nominal point
  bool complete = false;        ///< false: the budget was used up before the shrinking converged
  std::vector<KeyMargin> keys;  ///< margins that are not known yet have no values
};

/// Shrinks a violation in the Euclidean norm of the positions: along the ray to the nominal point,
/// then key by key toward the nominal value (all the way if that still violates), both by
/// bisection. Repeats until a round gains less than the tolerance, then computes the margins.
///
/// Guarantees: the result was evaluated and violates, and is no further from the nominal point than
/// `violation`. If it is complete, moving any single key by the tolerance toward its nominal value
/// removes the violation. Does not find the globally nearest violation unless the violations are a
/// half-space. Cost: about 10 evaluations for each key and round with a tolerance of 0.01.
///
/// PreconditionError unless the tolerance is positive. InternalError if `violation` passes or the
/// nominal point does not.
ShrinkResult Shrink(const SearchSpace& space, const UnitPoint& violation, double tolerance,
                    const EvaluatePoint& evaluate);

}  // namespace trackbed
