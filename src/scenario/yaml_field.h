#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// A key, and what the docs say of it.
struct Key {
  const char* name;
  const char* unit;  ///< "m/s"; empty for what is no quantity
  const char* text;  ///< for people, on one line
};

/// The key that says which other keys a section has.
inline constexpr Key kMethod{"method", "", "which one; each has keys of its own"};

enum class Need { kRequired, kOptional };

/// Allowed values of a number. `above` is exclusive, the others are inclusive.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();
};

inline constexpr Range kPositive{.above = 0.0};
inline constexpr Range kNotNegative{.min = 0.0};

inline constexpr Range kMap{.min = -1e5, .max = 1e5};          // [m]; beyond any route
inline constexpr Range kSpeedRange{.min = 0.0, .max = 100.0};  // [m/s]
inline constexpr Range kSteering{.min = -1.5, .max = 1.5};     // [rad]

/// The pairs of numbers in a list: what one is called and what many are, and the allowed values.
struct PairShape {
  const char* one;
  const char* many;
  Range first;
  Range second;
};

inline constexpr PairShape kPoint{"a point [x, y]", "points [x, y]", kMap, kMap};

/// "above 0 and at most 10"; empty when everything is allowed.
std::string AllowedBy(Range range);

using Names = std::vector<std::string>;

template <typename Enum>
using EnumNames = std::vector<std::pair<Enum, const char*>>;

}  // namespace trackbed
