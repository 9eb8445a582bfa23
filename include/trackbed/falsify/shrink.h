#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

/// The smallest violation near one that was found.
namespace trackbed {

/// What came of a run at a point.
struct Evaluation {
  std::optional<double> robustness{};  ///< none where there is no such scenario
  bool violated = false;
};

/// None when it may not be run: the runs are used up, or it was interrupted. The same point has
/// the same evaluation each time.
using EvaluatePoint = std::function<std::optional<Evaluation>(const UnitPoint& point)>;

/// How far a key can go alone, all others at their nominal values.
struct ReachAlone {
  double passes = 0.0;       ///< the last place that was seen to pass, toward the end of its range
  bool whole_range = false;  ///< which is the end itself
};

/// A key at the counterexample.
struct KeyMargin {
  /// The place nearest to the counterexample's, toward the nominal one and at most a tolerance (or
  /// the key's step) away, that passes with all others at the counterexample's. None for a key at
  /// its nominal value.
  std::optional<double> holds_to{};
  /// Change of the robustness for the whole range of the key, from the difference of points a
  /// tolerance to either side; none where they have no value.
  std::optional<double> sensitivity{};
  std::optional<ReachAlone> down{};  ///< none for a key whose nominal value is that end
  std::optional<ReachAlone> up{};
};

struct Shrunk {
  UnitPoint point;              ///< violates; was evaluated
  double robustness = 0.0;      ///< there
  double distance = 0.0;        ///< from the nominal point
  bool complete = false;        ///< false: the runs were used up before it was as small as it gets
  std::vector<KeyMargin> keys;  ///< what is not known yet has no values
};

/// Makes a violation smaller, in the Euclidean norm of the places: along the ray to the nominal
/// point, then key by key toward the nominal value (all the way where that still violates), both by
/// bisection, again and again until a round gains less than the tolerance. Then the margins.
///
/// Guarantees: the result was evaluated and violates, and is no further from the nominal point than
/// `violation`. If it is complete, no key can go a tolerance nearer to its nominal value by itself
/// and still violate. Does not find the nearest violation of all where violations are no
/// half-space.
/// Cost: about 10 evaluations for each key and round with a tolerance of 0.01.
///
/// PreconditionError unless the tolerance is positive. InternalError if `violation` passes or the
/// nominal point does not.
Shrunk Shrink(const SearchSpace& space, const UnitPoint& violation, double tolerance,
              const EvaluatePoint& evaluate);

}  // namespace trackbed
