#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

enum class Need { kRequired, kOptional };

/// Allowed values of a number. `above` is exclusive, the others are inclusive.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();
};

using Names = std::vector<std::string>;

template <typename Enum>
using EnumNames = std::vector<std::pair<Enum, const char*>>;

}  // namespace trackbed
