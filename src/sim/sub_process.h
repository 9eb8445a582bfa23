#pragma once

#include <functional>
#include <string>

namespace trackbed {

/// Result of a computation that runs in a separate process.
struct SubProcessOutcome {
  bool finished = false;  ///< Whether `compute` returned; if so, `result` is its return value.
  std::string result;
  /// Reason why `compute` did not return, such as "Segmentation fault" or "exit code 1".
  std::string cause;
};

/// Calls `compute` in a forked copy of this process. The copied process cannot open files, can
/// allocate at most `memory` bytes, and can use at most `seconds` of processor time. An error or
/// crash in the copied process does not affect this process. The terminal output of the copied
/// process is discarded.
///
/// `compute` must not throw, and must not use a lock that another thread may hold. If no process
/// can be started, InSubProcess throws RunError. In builds with sanitizers, which reserve terabytes
/// of address space, the memory is not limited.
SubProcessOutcome InSubProcess(const std::function<std::string()>& compute, std::size_t memory,
                               int seconds);

}  // namespace trackbed
