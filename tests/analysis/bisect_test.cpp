#include "trackbed/analysis/bisect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Passes for values up to and including `limit`.
std::function<std::optional<bool>(double)> UpTo(double limit) {
  return [limit](double value) { return value <= limit; };
}

TEST(Bisect, FindsTheHighestValueThatPasses) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const double from = std::uniform_real_distribution(-50.0, 50.0)(random);
    const double to = from + std::uniform_real_distribution(1e-3, 100.0)(random);
    const double limit = std::uniform_real_distribution(from, to)(random);
    const double tolerance = std::pow(10.0, std::uniform_real_distribution(-9.0, 1.0)(random));
    const Bisection found = Bisect(from, to, tolerance, UpTo(limit));
    SCOPED_TRACE(testing::Message() << from << " to " << to << ", limit " << limit);
    ASSERT_EQ(found.status, BisectStatus::kFound);
    EXPECT_LE(found.value, limit);
    // Halving is exact except for the rounding of the interval's ends, 1 ulp of at most 150.
    EXPECT_GE(found.value, limit - tolerance - 3e-14);
    EXPECT_LE(static_cast<double>(found.trials.size()),
              2.0 + std::max(0.0, std::ceil(std::log2((to - from) / tolerance))));
  }
}

TEST(Bisect, TriesBothEndsThenMiddles) {
  const Bisection found = Bisect(0.0, 8.0, 1.0, UpTo(5.5));
  EXPECT_THAT(found.trials,
              testing::ElementsAre(Trial{0.0, true}, Trial{8.0, false}, Trial{4.0, true},
                                   Trial{6.0, false}, Trial{5.0, true}));
  EXPECT_EQ(found.value, 5.0);
}

TEST(Bisect, SaysWhereThereIsNothingToFind) {
  const Bisection none = Bisect(1.0, 2.0, 0.1, UpTo(0.5));
  EXPECT_EQ(none.status, BisectStatus::kFailsAtFrom);
  EXPECT_EQ(none.trials.size(), 1U);
  const Bisection all = Bisect(1.0, 2.0, 0.1, UpTo(3.0));
  EXPECT_EQ(all.status, BisectStatus::kPassesAtTo);
  EXPECT_EQ(all.value, 2.0);
  EXPECT_EQ(all.trials.size(), 2U);
}

TEST(Bisect, StopsWhenItIsInterrupted) {
  for (const std::size_t runs : {0U, 1U, 2U, 4U}) {
    std::size_t run = 0;
    const Bisection stopped = Bisect(0.0, 8.0, 1e-3, [&](double value) -> std::optional<bool> {
      return run++ < runs ? std::optional(value <= 5.5) : std::nullopt;
    });
    EXPECT_EQ(stopped.status, BisectStatus::kInterrupted);
    EXPECT_EQ(stopped.trials.size(), runs);
  }
}

TEST(Bisect, EndsWhereNoNumberIsBetween) {
  const double limit = 1.0 + 5 * std::numeric_limits<double>::epsilon();
  const Bisection found = Bisect(1.0, 2.0, 1e-300, UpTo(limit));
  EXPECT_EQ(found.status, BisectStatus::kFound);
  EXPECT_EQ(found.value, limit);
}

TEST(Bisect, RefusesWhatIsNoStretch) {
  EXPECT_THROW(Bisect(2.0, 2.0, 0.1, UpTo(3.0)), InternalError);
  EXPECT_THROW(Bisect(1.0, 2.0, 0.0, UpTo(3.0)), InternalError);
}

}  // namespace
}  // namespace trackbed
