#include "trackbed/analysis/parallel.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <vector>

namespace trackbed {

void ForEachIndex(std::size_t count, int threads, const std::function<bool(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  const auto work_until_done = [&] {
    try {
      for (std::size_t index = next++; index < count; index = next++) {
        if (!work(index)) {
          next = count;
        }
      }
    } catch (...) {
      next = count;
      throw;
    }
  };
  // Keep the futures of all other threads: their destructors wait for these threads, even if the
  // work in this thread throws.
  std::vector<std::future<void>> others;
  const std::size_t workers = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
  for (std::size_t i = 1; i < workers; ++i) {
    others.push_back(std::async(std::launch::async, work_until_done));
  }
  work_until_done();
  for (std::future<void>& other : others) {
    other.get();
  }
}

}  // namespace trackbed
