#pragma once

#include <functional>
#include <string>

namespace trackbed {

/// Result of a computation in a separate process.
struct SubProcessOutcome {
  bool finished = false;  ///< Whether the function returned; then `result` is its return value.
  std::string result;
  std::string cause;  ///< Reason why the function did not return, such as "Segmentation fault" or
                      ///< "exit code 1".
};

/// Calls `compute` in a copy of this process. The copy cannot open files, can allocate at most
/// `memory` bytes, and can use at most `seconds` of processor time. An error or crash in the copy
/// does not affect this process. The output of the copy is discarded.
///
/// `compute` must not throw, and must not use a lock that another thread may hold. InSubProcess
/// throws RunError if no process can be started. In builds with sanitizers, which map terabytes of
/// address space, the memory is not limited.
SubProcessOutcome InSubProcess(const std::function<std::string()>& compute, std::size_t memory,
                               int seconds);

}  // namespace trackbed
