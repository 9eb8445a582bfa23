#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

const fs::path kTests = kRoot / "tests";

/// Returns the names that --gtest_filter takes, of the tests whose sources are in a folder. The
/// name of each case of a parameterized test ends with "/0".
std::vector<std::string> TestsIn(const fs::path& folder) {
  static const std::regex test(R"(\bTEST(_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  static const std::regex instance(R"(\bINSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+))");
  std::vector<std::pair<std::string, std::string>> parameterized;
  std::vector<std::pair<std::string, std::string>> instances;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".cpp") {
      continue;
    }
    const std::string text = ReadText(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), test), end; match != end; ++match) {
      if ((*match)[1] == "_P") {
        parameterized.emplace_back((*match)[2], (*match)[3]);
      } else {
        names.push_back((*match)[2].str() + "." + (*match)[3].str());
      }
    }
    for (std::sregex_iterator match(text.begin(), text.end(), instance), end; match != end;
         ++match) {
      instances.emplace_back((*match)[1], (*match)[2]);
    }
  }
  for (const auto& [prefix, suite] : instances) {
    for (const auto& [tested, name] : parameterized) {
      if (tested == suite) {
        names.push_back(prefix + "/" + suite + "." + name + "/0");
      }
    }
  }
  return names;
}

/// Returns whether a test has a name that a pattern of --gtest_filter with '*' accepts.
bool Accepts(const std::string& pattern, const std::vector<std::string>& tests) {
  std::string expression;
  for (const char c : pattern) {
    if (c == '*') {
      expression += ".*";
    } else {
      expression += c == '.' ? "\\." : std::string(1, c);
    }
  }
  const std::regex accepted(expression);
  return std::any_of(tests.begin(), tests.end(),
                     [&](const std::string& name) { return std::regex_match(name, accepted); });
}

// A renamed suite would otherwise move from the long or nightly tests to the tests of every run.
TEST(Filters, OfLongAndNightlyTestsAcceptTests) {
  const std::string build = ReadText(kTests / "CMakeLists.txt");
  static const std::regex setting(R"re(\nset\(TRACKBED_(?:LONG|NIGHTLY)_(\w+) "([^"]*)"\))re");
  std::size_t seen = 0;
  for (std::sregex_iterator match(build.begin(), build.end(), setting), end; match != end;
       ++match) {
    std::string folder = (*match)[1];
    if (!fs::is_directory(kTests / folder)) {
      folder = std::regex_replace(folder, std::regex("^planning_"), "planning/");
    }
    ASSERT_TRUE(fs::is_directory(kTests / folder)) << "there is no folder of tests " << folder;
    const std::vector<std::string> tests = TestsIn(kTests / folder);
    std::istringstream patterns((*match)[2]);
    for (std::string pattern; std::getline(patterns, pattern, ':');) {
      ++seen;
      EXPECT_TRUE(Accepts(pattern, tests))
          << "tests/CMakeLists.txt: no test in tests/" << folder << " has a name like " << pattern;
    }
  }
  EXPECT_GT(seen, 15U);  // the scan found the filters
}

}  // namespace
