#pragma once

#include <cstddef>
#include <cstdlib>
#include <optional>
#include <string>

namespace trackbed {

/// Returns the whole number in an environment variable; nullopt if the variable is not set.
inline std::optional<std::size_t> EnvironmentNumber(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? std::nullopt : std::optional<std::size_t>(std::stoul(text));
}

}  // namespace trackbed
