#pragma once

#include <any>
#include <type_traits>
#include <typeinfo>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// The options of a registered method, such as a planner: a value of any copyable struct that
/// declares its keys (key_visitor.h). The type of the options struct identifies the method. The
/// parameter `Kind` makes the options of planners and the options of controllers different types.
template <typename Kind>
class MethodOptions {
 public:
  template <typename Options>
  requires(!std::is_same_v<std::decay_t<Options>, MethodOptions>)
      MethodOptions(Options options)  // NOLINT(google-explicit-constructor): converts options
      : value_(std::move(options)), visit_([](KeyVisitor& keys, std::any& value) {
          Visit(keys, *std::any_cast<Options>(&value));
        }) {}

  template <typename Options>
  [[nodiscard]] bool Is() const {
    return value_.type() == typeid(Options);
  }

  /// Returns a pointer to the options if their type is `Options`, else null.
  template <typename Options>
  [[nodiscard]] const Options* GetIf() const {
    return std::any_cast<Options>(&value_);
  }
  template <typename Options>
  [[nodiscard]] Options* GetIf() {
    return std::any_cast<Options>(&value_);
  }

  /// Returns the options. Throws InternalError if the type of the options is not `Options`.
  template <typename Options>
  [[nodiscard]] const Options& Get() const {
    TRACKBED_CHECK(Is<Options>(), "options of another method: {}", value_.type().name());
    return *GetIf<Options>();
  }
  template <typename Options>
  [[nodiscard]] Options& Get() {
    TRACKBED_CHECK(Is<Options>(), "options of another method: {}", value_.type().name());
    return *GetIf<Options>();
  }

  friend bool AreOfOneMethod(const MethodOptions& a, const MethodOptions& b) {
    return a.value_.type() == b.value_.type();
  }
  friend void Visit(KeyVisitor& keys, MethodOptions& options) {
    options.visit_(keys, options.value_);
  }

 private:
  std::any value_;
  void (*visit_)(KeyVisitor& keys, std::any& value);
};

}  // namespace trackbed
