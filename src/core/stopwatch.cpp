#include "trackbed/core/stopwatch.h"

namespace trackbed {

double Stopwatch::Seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace trackbed
