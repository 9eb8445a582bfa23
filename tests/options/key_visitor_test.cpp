#include "trackbed/options/key_visitor.h"

#include <gtest/gtest.h>

namespace trackbed {
namespace {

TEST(AllowedBy, SaysTheRangeInWords) {
  EXPECT_EQ(AllowedBy({}), "");
  EXPECT_EQ(AllowedBy({.min = 1.0}), "at least 1");
  EXPECT_EQ(AllowedBy({.max = 2.5}), "at most 2.5");
  EXPECT_EQ(AllowedBy(kPositive), "above 0");
  EXPECT_EQ(AllowedBy({.max = 10.0, .above = 0.0}), "above 0 and at most 10");
  EXPECT_EQ(AllowedBy({.min = -1e12, .max = 1e9}), "at least -1e+12 and at most 1000000000");
}

TEST(WithinReason, BoundsEverySideThatHasNone) {
  const Key length{"length", "m", ""};
  EXPECT_EQ(AllowedBy(WithinReason(length, {})), "at least -100000 and at most 100000");
  EXPECT_EQ(AllowedBy(WithinReason(length, kPositive)), "above 0 and at most 100000");
  EXPECT_EQ(AllowedBy(WithinReason(length, {.max = 1e6})), "at least -100000 and at most 1000000");
  EXPECT_EQ(AllowedBy(WithinReason(length, {.min = 1.0, .max = 2.0})), "at least 1 and at most 2");
  EXPECT_EQ(AllowedBy(WithinReason({"k", "1/m^2", ""}, kNonNegative)),
            "at least 0 and at most 1e+12");
  EXPECT_TRUE(WithinReason({"yaw", "rad", ""}, kDirection).is_direction);
}

}  // namespace
}  // namespace trackbed
