#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

/// Shrinks a violation toward the nominal point.
namespace trackbed {

/// The result of a run at a point.
struct Evaluation {
  /// Robustness of the run; none if there is no such scenario.
  std::optional<double> robustness{};
  bool violated = false;
};

/// Evaluates a point. Nullopt if the budget is used up or the search was interrupted. The same
/// point must give the same evaluation each time.
using EvaluatePoint = std::function<std::optional<Evaluation>(const UnitPoint& point)>;

/// How far one key can be moved while all other keys have their nominal values.
struct SingleKeyReach {
  /// The outermost position that passed, toward the end of the range.
  double passes = 0.0;
  bool whole_range = false;  ///< Whether that position is the end of the range.
};

/// The margins of one key at the counterexample.
struct KeyMargin {
  /// The nearest position, toward the nominal one, that passes with all other keys at the
  /// counterexample's values. This position is at most a tolerance (or the key's step) away from
  /// the counterexample. Nullopt for a key at its nominal value.
  std::optional<double> holds_to{};
  /// Change of the robustness over the whole range of the key, extrapolated from points a tolerance
  /// to either side. Nullopt if one of the two points has no robustness.
  std::optional<double> sensitivity{};
  /// Reach downwards; none for a key whose nominal value is the range's end.
  std::optional<SingleKeyReach> down{};
  std::optional<SingleKeyReach> up{};
};

struct ShrinkResult {
  UnitPoint point;              ///< Shrunk violation, which was evaluated.
  double robustness = 0.0;      ///< Robustness at `point`.
  double distance = 0.0;        ///< Distance of `point` from the nominal point.
  bool complete = false;        ///< False if the budget was used up before the shrinking converged.
  std::vector<KeyMargin> keys;  ///< Margins by key; margins that are not known yet have no values.
};

/// Shrinks a violation in the Euclidean norm of the positions. Bisects along the ray to the nominal
/// point, then for each key between the value and the nominal value. A key takes its nominal value
/// if that still violates. Rounds repeat until one gains less than the tolerance; then the margins
/// are computed.
///
/// Guarantees: the result was evaluated and violates, and is no further from the nominal point than
/// `violation`. If the result is complete, moving any single key by the tolerance toward its
/// nominal value removes the violation. The result is only guaranteed to be the globally nearest
/// violation if the violations are a half-space. Cost: about 10 evaluations for each key and round
/// with a tolerance of 0.01.
///
/// PreconditionError unless the tolerance is positive. InternalError if `violation` passes or the
/// nominal point fails.
ShrinkResult Shrink(const SearchSpace& space, const UnitPoint& violation, double tolerance,
                    const EvaluatePoint& evaluate);

}  // namespace trackbed
