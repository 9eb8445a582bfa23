#pragma once

#include <string_view>

#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// Largest coordinate of a place, in either direction [m]; northings of UTM are below 1e7.
inline constexpr double kMaxCoordinate = 1e7;

/// Range of the coordinates of places, whose keys are named x and y. If a scenario is moved to a
/// local origin, every key with this range is moved as a coordinate (local_origin.h).
inline constexpr Range kPlace{.min = -kMaxCoordinate, .max = kMaxCoordinate};

/// A list of places.
inline constexpr PairShape kPlaces{"a point [x, y]", "points [x, y]", kPlace, kPlace};

/// Returns whether a number with this range is a coordinate of a place.
inline bool IsCoordinate(const Range& range) {
  return range.min == kPlace.min && range.max == kPlace.max;
}

}  // namespace trackbed
