#pragma once

#include <string>

#include "trackbed/core/error.h"

namespace trackbed {

/// Returns the message of the Error that a call throws; an empty text if the call throws none.
template <class Error = InputError>
std::string ErrorText(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace trackbed
