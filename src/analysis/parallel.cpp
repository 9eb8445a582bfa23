#include "trackbed/analysis/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <future>
#include <vector>

namespace trackbed {

#ifdef __SANITIZE_THREAD__

// Plain threads for the thread sanitizer, which reports false races inside oneTBB because that
// library is not instrumented. Races between runs are found with any threads.
void ForEachIndex(std::size_t count, int threads, const std::function<bool(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::vector<std::future<void>> workers;
  for (int i = 0; i < threads; ++i) {
    workers.push_back(std::async(std::launch::async, [&] {
      for (std::size_t index = next++; index < count; index = next++) {
        if (!work(index)) {
          next = count;
        }
      }
    }));
  }
  for (std::future<void>& worker : workers) {
    worker.get();
  }
}

#else

void ForEachIndex(std::size_t count, int threads, const std::function<bool(std::size_t)>& work) {
  // Allows more threads than processors.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::task_group_context context;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            if (!context.is_group_execution_cancelled() && !work(i)) {
              context.cancel_group_execution();
            }
          }
        },
        tbb::simple_partitioner(), context);
  });
}

#endif

}  // namespace trackbed
