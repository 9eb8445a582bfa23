#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/support/shell.h"
#include "tests/support/temp_folder.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> RunAndRead(const fs::path& out) {
  Scenario scenario =
      ReadScenario(fs::path(TRACKBED_SOURCE_DIR) / "scenarios" / "playback_lane_change.yaml");
  WriteRunFolder(RunScenario(scenario), out, {.mcap = true});
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(out)) {
    if (entry.path().filename() != "timing.json") {
      files[entry.path().filename().string()] = ReadFile(entry.path());
    }
  }
  return files;
}

// A program that embeds Trackbed may set its user's locale, for C and for C++.
TEST(RunScenario, WritesTheSameBytesInALocaleWithADecimalComma) {
  const TempFolder folder;
  const auto expected = RunAndRead(folder.path() / "point");
  Shell(folder, "localedef -i de_DE -f UTF-8 ./de_DE.UTF-8");
  ::setenv("LOCPATH", folder.path().c_str(), 1);
  std::locale comma;
  try {
    comma = std::locale("de_DE.UTF-8");
  } catch (const std::runtime_error& error) {
    GTEST_SKIP() << "localedef, with Debian's package locales, cannot make de_DE.UTF-8";
  }
  const std::locale before = std::locale::global(comma);  // also sets the C locale
  ASSERT_STREQ(std::localeconv()->decimal_point, ",");
  const auto files = RunAndRead(folder.path() / "comma");
  EXPECT_STREQ(std::localeconv()->decimal_point, ",") << "it is left as it was";
  EXPECT_EQ(std::locale(), comma);
  std::locale::global(before);
  ::unsetenv("LOCPATH");
  ASSERT_EQ(files.size(), expected.size());
  for (const auto& [name, bytes] : expected) {
    EXPECT_TRUE(files.at(name) == bytes) << name;
  }
}

}  // namespace
}  // namespace trackbed
