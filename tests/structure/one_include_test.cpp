#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

/// Returns the public headers that a file includes, such as "trackbed/control/lqr.h".
std::vector<std::string> PublicIncludes(const fs::path& file) {
  static const std::regex include(R"re(#include "(trackbed/[\w/]+\.h)")re");
  const std::string text = ReadText(kRoot / file);
  std::vector<std::string> headers;
  for (std::sregex_iterator match(text.begin(), text.end(), include), end; match != end; ++match) {
    headers.push_back((*match)[1]);
  }
  return headers;
}

/// Whether a header declares a function without arguments that returns the entry of a method.
bool DeclaresEntry(const std::string& header) {
  static const std::regex entry(R"(\n(Planner|Controller)Entry \w+\(\);)");
  return std::regex_search(ReadText(kRoot / "include" / header), entry);
}

/// trackbed.h lets programs set the options of every registered planner and controller. A header
/// with an entry may take the options from a header with the beginning of its name: the options of
/// optimal_steering_controller.h are in optimal_steering.h.
TEST(OneInclude, HasTheOptionsOfAllMethods) {
  const std::vector<std::string> all = PublicIncludes("include/trackbed/trackbed.h");
  const auto is_included = [&](const std::string& header) {
    return std::find(all.begin(), all.end(), header) != all.end();
  };
  for (const fs::path registry :
       {"src/planning/registry/planners.cpp", "src/control/controllers.cpp"}) {
    int count = 0;
    for (const std::string& header : PublicIncludes(registry)) {
      if (!DeclaresEntry(header)) {
        continue;
      }
      ++count;
      const std::vector<std::string> own = PublicIncludes("include/" + header);
      EXPECT_TRUE(is_included(header) ||
                  std::any_of(own.begin(), own.end(),
                              [&](const std::string& other) {
                                return header.rfind(fs::path(other).replace_extension().string(),
                                                    0) == 0 &&
                                       is_included(other);
                              }))
          << "include/trackbed/trackbed.h does not include " << header << " of " << registry;
    }
    EXPECT_GT(count, 8) << registry;
  }
}

}  // namespace
