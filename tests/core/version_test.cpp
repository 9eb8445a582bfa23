#include "trackbed/core/version.h"

#include <gtest/gtest.h>

#include <string>

namespace trackbed {
namespace {

TEST(Version, StartsWithANumber) {
  const std::string version = Version();
  ASSERT_FALSE(version.empty());
  EXPECT_GE(version[0], '0');
  EXPECT_LE(version[0], '9');
  EXPECT_NE(version.find('.'), std::string::npos);
}

}  // namespace
}  // namespace trackbed
