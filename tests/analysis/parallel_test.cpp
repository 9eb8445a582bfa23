#include "trackbed/analysis/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace trackbed {
namespace {

TEST(ForEachIndex, CallsEveryIndexOnce) {
  for (const int threads : {1, 2, 7}) {
    for (const std::size_t count : {0U, 1U, 3U, 1000U}) {
      std::vector<std::atomic<int>> calls(count);
      ForEachIndex(count, threads, [&](std::size_t i) {
        ++calls[i];
        return true;
      });
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(calls[i], 1) << i << " of " << count << " on " << threads;
      }
    }
  }
}

TEST(ForEachIndex, HasAtMostAsManyCallsAtOnceAsThreads) {
  std::atomic<int> at_once{0};
  std::atomic<int> most{0};
  ForEachIndex(10'000, 3, [&](std::size_t) {
    const int now = ++at_once;
    for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
    }
    --at_once;
    return true;
  });
  EXPECT_LE(most, 3);
}

TEST(ForEachIndex, EndsWhenACallReturnsFalse) {
  std::size_t calls = 0;
  ForEachIndex(1000, 1, [&](std::size_t i) {
    ++calls;
    return i < 5;
  });
  EXPECT_EQ(calls, 6U);
}

TEST(ForEachIndex, RethrowsAndEnds) {
  for (const int threads : {1, 4}) {
    // Every index above 100 throws, so each thread makes at most one call above 100.
    std::atomic<std::size_t> above{0};
    EXPECT_THROW(ForEachIndex(1'000'000, threads,
                              [&](std::size_t i) {
                                if (i > 100) {
                                  ++above;
                                  throw std::runtime_error("fails");
                                }
                                return true;
                              }),
                 std::runtime_error);
    EXPECT_LE(above, static_cast<std::size_t>(threads));
  }
}

}  // namespace
}  // namespace trackbed
