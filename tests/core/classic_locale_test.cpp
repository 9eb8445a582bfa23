#include "trackbed/core/classic_locale.h"

#include <gtest/gtest.h>

#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

namespace trackbed {
namespace {

/// As in German: a comma as the decimal separator, a dot between thousands.
class Comma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

class ClassicLocaleTest : public testing::Test {
 public:
  ClassicLocaleTest()
      : comma_(std::locale::classic(), new Comma), before_(std::locale::global(comma_)) {}
  ~ClassicLocaleTest() override { std::locale::global(before_); }

  static double Read(const std::string& text) {
    double number = 0.0;
    std::istringstream(text) >> number;
    return number;
  }

  std::locale comma_;
  std::locale before_;
};

TEST_F(ClassicLocaleTest, ReadsADotAsOne) {
  EXPECT_EQ(Read("1.500"), 1500.0);
  {
    const ClassicLocale locale;
    EXPECT_EQ(Read("1.500"), 1.5);
  }
  EXPECT_EQ(Read("1.500"), 1500.0);
  EXPECT_EQ(std::locale(), comma_);
}

TEST_F(ClassicLocaleTest, LastsUntilTheLastOneGoes) {
  std::optional<ClassicLocale> first(std::in_place);
  std::optional<ClassicLocale> second(std::in_place);
  first.reset();
  std::thread([] { const ClassicLocale of_another_thread; }).join();
  EXPECT_EQ(Read("1.500"), 1.5);
  second.reset();
  EXPECT_EQ(std::locale(), comma_);
}

}  // namespace
}  // namespace trackbed
