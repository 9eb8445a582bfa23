#pragma once

#include <stdexcept>
#include <string>

namespace trackbed {

/// An exception of a method that the user's program has registered: a planner, a controller, a
/// plant or a metric. The text `what()` names the method and states the problem, on one line. For a
/// MethodError, the program prints only the text; for other unexpected exceptions, the program
/// prints "internal error".
class MethodError : public std::runtime_error {
 public:
  explicit MethodError(const std::string& message);
};

}  // namespace trackbed
