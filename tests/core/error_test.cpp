#include "trackbed/core/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace trackbed {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Problem, SaysWhereAndWhat) {
  EXPECT_EQ((Problem{"a.yaml", 3, 7, "mission.speed", "is -1; must be > 0"}.ToString()),
            "a.yaml:3:7: mission.speed: is -1; must be > 0");
}

TEST(Problem, LeavesOutWhatIsUnknown) {
  EXPECT_EQ((Problem{.message = "what"}.ToString()), "what");
  EXPECT_EQ((Problem{.key = "key", .message = "what"}.ToString()), "key: what");
  EXPECT_EQ((Problem{.file = "a.csv", .message = "what"}.ToString()), "a.csv: what");
  EXPECT_EQ((Problem{.file = "a.csv", .key = "key", .message = "what"}.ToString()),
            "a.csv: key: what");
  EXPECT_EQ((Problem{.file = "a.csv", .line = 2, .column = 5, .message = "what"}.ToString()),
            "a.csv:2:5: what");
}

TEST(Problem, LeavesOutAnUnknownColumn) {
  EXPECT_EQ((Problem{.file = "a.csv", .line = 2, .message = "what"}.ToString()), "a.csv:2: what");
}

TEST(Problem, NamesControlCharactersOfOtherPeoplesNames) {
  EXPECT_EQ((Problem{.file = "\x1b[31mred\x7f", .message = "tab\tand\nline"}.ToString()),
            "<U+001B>[31mred<U+007F>: tab\tand<U+000A>line");  // a message stays on one line
  EXPECT_EQ(WithoutControls("Prüfstrecke"), "Prüfstrecke");
}

// U+202E shows the text after it backwards, so "U+202E lmx.exe" looks like "exe.xml".
TEST(WithoutControls, NamesMarksOfWritingDirection) {
  EXPECT_EQ(WithoutControls("\u202Elmx.exe\u2066a\u2069\u200Fb\u2028\u061C"),
            "<U+202E>lmx.exe<U+2066>a<U+2069><U+200F>b<U+2028><U+061C>");
  const std::string joined = "\u05E9\u05DC\u05D5\u05DD \U0001F469\u200D\U0001F467 a\u0301\tb\n";
  EXPECT_EQ(WithoutControls(joined), joined);
}

TEST(InputError, ListsEveryProblemOnItsLine) {
  const InputError error(std::vector<Problem>{
      {.key = "a", .message = "one"}, {.file = "f", .line = 1, .column = 2, .message = "two"}});
  EXPECT_STREQ(error.what(), "a: one\nf:1:2: two");
  ASSERT_EQ(error.problems().size(), 2U);
  EXPECT_EQ(error.problems()[1].message, "two");
}

TEST(InputError, OfOneProblemIsOneLine) {
  EXPECT_STREQ(InputError(Problem{.message = "one"}).what(), "one");
}

TEST(Require, PassesWhatHolds) {
  EXPECT_NO_THROW(TRACKBED_REQUIRE(1 + 1 == 2, "sum {}", 2));
}

TEST(Require, SaysWhatIsWrongAndNothingElse) {
  const int three = 3;
  try {
    TRACKBED_REQUIRE(three < 2, "three is {}; must be below {}", three, 2);
    FAIL() << "did not throw";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "three is 3; must be below 2");  // no bug report
  }
}

TEST(Check, PassesWhatHolds) {
  EXPECT_NO_THROW(TRACKBED_CHECK(1 + 1 == 2, "sum {}", 2));
}

TEST(Check, NamesPlaceConditionAndValues) {
  const int three = 3;
  try {
    TRACKBED_CHECK(three < 2, "three is {}", three);
    FAIL() << "did not throw";
  } catch (const InternalError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("error_test.cpp:"), HasSubstr("three is 3"),
                                    HasSubstr("three < 2 does not hold")));
    EXPECT_EQ(std::string(error.what()).find('/'), std::string::npos);  // no build path
  }
}

}  // namespace
}  // namespace trackbed
