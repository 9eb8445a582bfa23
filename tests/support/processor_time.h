#pragma once

#include <sys/resource.h>

#include <initializer_list>

namespace trackbed {

/// Returns the processor time [s] of this process and of its child processes that have ended.
/// Unlike the elapsed time, the processor time depends little on the load of the machine.
inline double ProcessorTime() {
  double sum = 0.0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime}) {
      sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
  }
  return sum;
}

}  // namespace trackbed
