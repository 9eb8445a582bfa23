#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

/// Returns the number of arguments of a macro whose opening parenthesis is before `at`.
std::size_t CountArguments(std::string_view text, std::size_t at) {
  std::size_t count = 1;
  for (int depth = 1; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') {
      for (++at; at < text.size() && text[at] != '"'; ++at) {
        at += text[at] == '\\' ? 1U : 0U;
      }
    } else if (c == '(' || c == '{' || c == '[') {
      ++depth;
    } else if (c == ')' || c == '}' || c == ']') {
      if (--depth == 0) {
        break;
      }
    } else if (c == ',' && depth == 1) {
      ++count;
    }
  }
  return count;
}

// A case without a name is called by its number, which changes when a case is added before it.
TEST(Cases, HaveNames) {
  constexpr std::string_view kMacro = "INSTANTIATE_TEST_SUITE_P(";
  std::size_t seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / "tests")) {
    if (entry.path().extension() != ".cpp" || entry.path().filename() == "cases_test.cpp") {
      continue;
    }
    std::ostringstream read;
    read << std::ifstream(entry.path()).rdbuf();
    const std::string text = read.str();
    for (std::size_t at = text.find(kMacro); at != std::string::npos;
         at = text.find(kMacro, at + 1)) {
      ++seen;
      EXPECT_GE(CountArguments(text, at + kMacro.size()), 4U)
          << fs::relative(entry.path(), kRoot).generic_string() << ":"
          << 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')
          << ": give the cases names, for example with kNamedByParameter";
    }
  }
  EXPECT_GT(seen, 50U);  // the scan found the cases
}

}  // namespace
