#include "trackbed/core/spelling.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace trackbed {
namespace {

const std::vector<std::string> kKnown{"preview", "schedule", "constant_steering"};

TEST(NearestSpelling, FindsASlip) {
  EXPECT_EQ(NearestSpelling("preveiw", kKnown), "preview");     // two replaced
  EXPECT_EQ(NearestSpelling("schedul", kKnown), "schedule");    // one left out
  EXPECT_EQ(NearestSpelling("schedulle", kKnown), "schedule");  // one too many
  EXPECT_EQ(NearestSpelling("preview", kKnown), "preview");
}

TEST(NearestSpelling, TakesAThirdOfALongWord) {
  // 17 letters: five edits count as similar, six do not.
  EXPECT_EQ(NearestSpelling("xxxxxant_steering", kKnown), "constant_steering");
  EXPECT_EQ(NearestSpelling("xxxxxxnt_steering", kKnown), "");
}

TEST(NearestSpelling, TakesTwoOfAShortWord) {
  EXPECT_EQ(NearestSpelling("abc", {"xyc"}), "xyc");
  EXPECT_EQ(NearestSpelling("abc", {"xyz"}), "");
}

TEST(NearestSpelling, KeepsSomethingOfTheWord) {
  EXPECT_EQ(NearestSpelling("x", {"box"}), "");
  EXPECT_EQ(NearestSpelling("x", {"y"}), "");
  EXPECT_EQ(NearestSpelling("ab", {"xy"}), "");
  EXPECT_EQ(NearestSpelling("xb", {"xy"}), "xy");
  EXPECT_EQ(NearestSpelling("xx", {"x"}), "x");
  EXPECT_EQ(NearestSpelling("", {"x", "xy"}), "");
}

TEST(NearestSpelling, OfNothingKnownIsEmpty) {
  EXPECT_EQ(NearestSpelling("a", {}), "");
}

TEST(NearestSpelling, TiesGoToTheEarlierWord) {
  EXPECT_EQ(NearestSpelling("cat", {"bat", "hat"}), "bat");
  EXPECT_EQ(NearestSpelling("cat", {"hat", "bat"}), "hat");
  EXPECT_EQ(NearestSpelling("cat", {"bat", "cat"}), "cat");
}

TEST(UnknownName, SuggestsOrLists) {
  EXPECT_EQ(UnknownName("preveiw", kKnown), "'preveiw'; did you mean 'preview'?");
  EXPECT_EQ(UnknownName("zzzzzz", kKnown),
            "'zzzzzz'; allowed: preview, schedule, constant_steering");
  EXPECT_EQ(UnknownName("rubber", {"contact"}), "'rubber'; allowed: contact");
}

}  // namespace
}  // namespace trackbed
