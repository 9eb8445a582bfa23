#include "src/scenario/yaml_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace trackbed {

std::string AllowedBy(Range range) {
  std::vector<std::string> parts;
  if (std::isfinite(range.above)) {
    parts.push_back(fmt::format("above {}", range.above));
  }
  if (std::isfinite(range.min)) {
    parts.push_back(fmt::format("at least {}", range.min));
  }
  if (std::isfinite(range.max)) {
    parts.push_back(fmt::format("at most {}", range.max));
  }
  return fmt::format("{}", fmt::join(parts, " and "));
}

}  // namespace trackbed
