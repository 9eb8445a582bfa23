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
}

}  // namespace
}  // namespace trackbed
