#pragma once

#include <functional>
#include <string>

namespace trackbed {

/// Result of a computation in a separate process.
struct SubProcessOutcome {
  bool finished = false;  ///< whether the function returned; `result` is then its return value
  std::string result;
  std::string cause;  ///< reason if the function did not return: "Segmentation fault", "exit code
                      ///< 1"
};

/// Calls `compute` in a copy of this process. The copy can open no file. The copy may allocate
/// `memory` bytes and use `seconds` of processor time. No error in the copy, not even a crash,
/// affects this process. The copy's output is discarded.
///
/// `compute` must not throw and must not use a lock that another thread may hold. InSubProcess
/// throws RunError if no process can be started. Under sanitizers, which map terabytes, the process
/// has no memory limit.
SubProcessOutcome InSubProcess(const std::function<std::string()>& compute, std::size_t memory,
                               int seconds);

}  // namespace trackbed
