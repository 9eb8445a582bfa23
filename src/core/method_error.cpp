#include "trackbed/core/method_error.h"

namespace trackbed {

MethodError::MethodError(const std::string& message) : std::runtime_error(message) {}

}  // namespace trackbed
