#pragma once

#include <functional>
#include <string>

namespace trackbed {

/// How a computation in a process of its own ended.
struct SubProcessOutcome {
  bool finished = false;  ///< `result` is what the function gave back
  std::string result;
  std::string cause;  ///< of one that did not finish: "Segmentation fault", "exit code 1"
};

/// Calls `compute` in a copy of this process, which can open no file, has `memory` bytes beside
/// what this process has, and `seconds` of processor time. What happens there, a crash included,
/// leaves this process as it is; nothing that it prints is seen.
///
/// `compute` must not throw, and must use no lock that another thread may hold. RunError when no
/// process can be started. The limit of memory is left out under sanitizers, which map terabytes.
SubProcessOutcome InSubProcess(const std::function<std::string()>& compute, std::size_t memory,
                               int seconds);

}  // namespace trackbed
