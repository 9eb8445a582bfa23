#include "src/analysis/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace trackbed {

void ForEachIndex(std::size_t count, int threads, const std::function<bool(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto worker = [&] {
    for (std::size_t i = next++; i < count && !stop; i = next++) {
      try {
        if (!work(i)) {
          stop = true;
        }
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = failure ? failure : std::current_exception();
        stop = true;
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    const auto size = std::min(static_cast<std::size_t>(threads), count);
    for (std::size_t i = 0; i < size; ++i) {
      workers.emplace_back(worker);
    }
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace trackbed
