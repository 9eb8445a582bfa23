#include "trackbed/options/key_visitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

struct Inner {
  std::optional<double> width;
};
void Visit(KeyVisitor& keys, Inner& inner) {
  keys.Field({"width", "m", "a width"}, inner.width, kPositive);
}

struct Outer {
  double length = 1.0;
  int count = 2;
  Inner inner;
  std::vector<Inner> list;
  std::vector<Vec2> points;
};
void Visit(KeyVisitor& keys, Outer& outer) {
  keys.Field({"length", "m", "a length"}, outer.length, Need::kOptional, kNonNegative);
  keys.Field({"count", "", "a count"}, outer.count, Need::kOptional, Range{.max = 3.0});
  keys.Section({"inner", "", "a section"}, outer.inner);
  keys.List({"list", "", "a list"}, outer.list);
  keys.Field({"points", "m", "points"}, outer.points, Need::kOptional);
}

std::string Refusal(Outer outer) {
  try {
    RequireInRange("Call", [&](KeyVisitor& keys) { Visit(keys, outer); });
    return "";
  } catch (const PreconditionError& error) {
    return error.what();
  }
}

TEST(RequireInRange, NamesTheKeyItsValueAndWhatIsAllowed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Refusal({}), "");
  EXPECT_EQ(Refusal({.length = 0.0, .inner = {.width = 1e-300}, .list = {{}, {2.0}}}), "");
  EXPECT_EQ(Refusal({.length = -1.0}), "Call: length is -1; must be finite, at least 0");
  EXPECT_EQ(Refusal({.length = nan}), "Call: length is nan; must be finite, at least 0");
  EXPECT_EQ(Refusal({.length = HUGE_VAL}), "Call: length is inf; must be finite, at least 0");
  EXPECT_EQ(Refusal({.count = 4}), "Call: count is 4; must be finite, at most 3");
  EXPECT_EQ(Refusal({.inner = {0.0}}), "Call: inner.width is 0; must be finite, above 0");
  EXPECT_EQ(Refusal({.list = {{1.0}, {nan}}}),
            "Call: list[1].width is nan; must be finite, above 0");
  EXPECT_THAT(Refusal({.points = {{0.0, nan}}}), testing::StartsWith("Call: points is nan"));
}

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
