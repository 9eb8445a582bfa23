#pragma once

#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>

#include "src/fmu/unit/unit.h"
#include "trackbed/core/error.h"

/// Functions that the C functions of FMI 2 and FMI 3 share.
namespace trackbed::fmu {

/// Calls the function `call`. If `call` throws, Guarded passes the message to `fail` and returns
/// false. No exception may leave Guarded, because its caller is C code.
template <typename Call, typename Fail>
bool Guarded(const Call& call, const Fail& fail) noexcept {
  try {
    call();
    return true;
  } catch (const std::exception& error) {
    try {
      fail(error.what());
    } catch (...) {
      return false;
    }
  } catch (...) {
    try {
      fail("an unknown exception");
    } catch (...) {
      return false;
    }
  }
  return false;
}

/// Throws InputError if a pointer argument of a C function is null.
template <typename Value>
void RequireGiven(const Value* pointer, const char* name) {
  if (pointer == nullptr) {
    throw InputError(Problem{.message = std::string("the argument ") + name + " is null"});
  }
}

/// Converts an argument value of a C function to a double. Throws InputError for integers beyond
/// 2^53, which a double may not hold exactly.
template <typename Value>
double ToDouble(Value value) {
  const auto converted = static_cast<double>(value);
  if constexpr (std::is_same_v<Value, std::int64_t>) {
    if (std::abs(converted) > 9007199254740992.0) {
      throw InputError(Problem{.message = "an integer is beyond 2^53"});
    }
  }
  return converted;
}

template <typename Value>
void SetAll(Unit& unit, Type type, const std::uint32_t* references, std::size_t count,
            const Value* values) {
  for (std::size_t i = 0; i < count; ++i) {
    RequireGiven(references, "valueReferences");
    RequireGiven(values, "values");
    unit.Set(type, references[i], ToDouble(values[i]));
  }
}

template <typename Value>
void GetAll(Unit& unit, Type type, const std::uint32_t* references, std::size_t count,
            Value* values) {
  for (std::size_t i = 0; i < count; ++i) {
    RequireGiven(references, "valueReferences");
    RequireGiven(values, "values");
    const double value = unit.Get(type, references[i]);
    if constexpr (std::is_same_v<Value, bool>) {
      values[i] = value != 0.0;
    } else {
      values[i] = static_cast<Value>(value);
    }
  }
}

/// Converts a URI such as "file:///tmp/fmu/resources" to a path. Throws InputError for a URI with
/// another scheme.
std::filesystem::path PathOfUri(const std::string& uri);

/// Copies a serialized state. Throws InputError if the buffer `target` of `size` bytes is too
/// small.
void CopyTo(const std::string& bytes, void* target, std::size_t size);

}  // namespace trackbed::fmu
