#pragma once

#include <functional>
#include <string>

namespace trackbed {

/// Result of a computation in a separate process.
struct SubProcessOutcome {
  bool finished = false;  ///< `result` is the function's return value
  std::string result;
  std::string cause;  ///< if it did not finish: "Segmentation fault", "exit code 1"
};

/// Calls `compute` in a copy of this process. The copy can open no file; it may allocate `memory`
/// bytes and use `seconds` of processor time. Nothing in it, not even a crash, affects this
/// process; its output is discarded.
///
/// `compute` must not throw and must not use a lock that another thread may hold. RunError if no
/// process can be started. The memory limit is omitted under sanitizers, which map terabytes.
SubProcessOutcome InSubProcess(const std::function<std::string()>& compute, std::size_t memory,
                               int seconds);

}  // namespace trackbed
