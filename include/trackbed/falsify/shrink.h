#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

/// Shrinks a violation toward the nominal point.
namespace trackbed {

/// The result of a run at a point.
struct Evaluation {
  /// Robustness of the run; nullopt if the scenario is invalid.
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
  bool whole_range = false;  ///< Whether `passes` is the end of the range.
};

/// The margins of one key at the counterexample.
struct KeyMargin {
  /// The nearest position, toward the nominal one, that passes with all other keys at the
  /// counterexample's values. The distance from the counterexample to this position is at most the
  /// tolerance (or the key's step). The position is nullopt for a key at its nominal value.
  std::optional<double> holds_to{};
  /// Change of the robustness over the whole range of the key, extrapolated from two points, one
  /// tolerance below and one above the counterexample. The sensitivity is nullopt if one of the two
  /// points has no robustness.
  std::optional<double> sensitivity{};
  /// Reach toward lower values; nullopt if the nominal value is the lower end of the range.
  std::optional<SingleKeyReach> down{};
  std::optional<SingleKeyReach> up{};
};

struct ShrinkResult {
  UnitPoint point;              ///< Shrunk violation, which was evaluated.
  double robustness = 0.0;      ///< Robustness at `point`.
  double distance = 0.0;        ///< Distance of `point` from the nominal point.
  bool complete = false;        ///< False if the budget was used up before the shrinking converged.
  std::vector<KeyMargin> keys;  ///< Margins by key; unknown margins are nullopt.
};

/// Shrinks the Euclidean distance of a violation from the nominal point in the unit cube. Each
/// round bisects along the ray to the nominal point, then along each key between its value and its
/// nominal value. If a key's nominal value still gives a violation, the key takes this value. The
/// rounds repeat until a round shortens the distance by less than the tolerance; then the margins
/// are computed.
///
/// Guarantees: the result was evaluated, is a violation, and is no further from the nominal point
/// than `violation`. If the result is complete, moving any single key by the tolerance toward its
/// nominal value removes the violation. The result is only guaranteed to be the globally nearest
/// violation if the set of violations is a half-space. Cost: about 10 evaluations for each key and
/// round with a tolerance of 0.01.
///
/// PreconditionError unless the tolerance is positive. InternalError if `violation` passes or the
/// nominal point fails.
ShrinkResult Shrink(const SearchSpace& space, const UnitPoint& violation, double tolerance,
                    const EvaluatePoint& evaluate);

}  // namespace trackbed
