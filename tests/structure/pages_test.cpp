#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kFolder = TRACKBED_SOURCE_DIR;

/// Paths that pages name although the tree does not contain them: files of examples, and of MuJoCo.
const std::vector<std::string> kElsewhere{"render/heading_line.h", "render/heading_line.cpp",
                                          "include/mujoco/mujoco.h"};

/// Folders from which pages name files.
constexpr std::array<const char*, 3> kRoots{".", "include", "include/trackbed"};

std::vector<fs::path> Pages() {
  std::vector<fs::path> pages{kFolder / "README.md", kFolder / "CONTRIBUTING.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kFolder / "docs")) {
    if (entry.path().extension() == ".md") {
      pages.push_back(entry.path());
    }
  }
  return pages;
}

/// Returns the paths in backquotes outside of code blocks: from the root of the tree, and headers
/// or sources from one of its folders. A word in capitals, such as NAME, is a placeholder.
std::vector<std::string> PathsIn(const fs::path& page) {
  static const std::regex path(
      "`((?:src|include|tests|render|scripts|cmake|models|scenarios|python|bench)/[a-z0-9_./-]+|"
      "[a-z0-9_]+/[a-z0-9_/]+\\.(?:h|cpp))`");
  std::vector<std::string> paths;
  bool is_code = false;
  std::ifstream in(page);
  for (std::string line; std::getline(in, line);) {
    is_code = line.find("```") != std::string::npos ? !is_code : is_code;
    for (std::sregex_iterator match(line.begin(), line.end(), path), end; !is_code && match != end;
         ++match) {
      paths.push_back((*match)[1]);
    }
  }
  return paths;
}

/// Returns whether the path leads to a file from the root of the tree, or as sources include it.
bool Exists(const std::string& path) {
  return std::any_of(kRoots.begin(), kRoots.end(),
                     [&](const char* root) { return fs::exists(kFolder / root / path); });
}

TEST(Pages, NameFilesThatExist) {
  std::size_t seen = 0;
  for (const fs::path& page : Pages()) {
    for (const std::string& path : PathsIn(page)) {
      ++seen;
      const bool is_elsewhere =
          std::find(kElsewhere.begin(), kElsewhere.end(), path) != kElsewhere.end();
      EXPECT_TRUE(is_elsewhere || Exists(path))
          << fs::relative(page, kFolder) << " names " << path << ", which does not exist";
    }
  }
  EXPECT_GT(seen, 100U);  // the scan found paths
}

/// Returns the functions that a struct of a header holds as pointers, such as `check`.
std::set<std::string> FunctionsOf(const std::string& name, const fs::path& header) {
  static const std::regex pointer("\\(\\*(\\w+)\\)\\(");
  std::ostringstream read;
  read << std::ifstream(kFolder / header).rdbuf();
  const std::string text = read.str();
  const std::size_t begin = text.find("struct " + name + " {");
  EXPECT_NE(begin, std::string::npos) << name;
  const std::string body = text.substr(begin, text.find("\n};", begin) - begin);
  std::set<std::string> functions;
  for (std::sregex_iterator match(body.begin(), body.end(), pointer), end; match != end; ++match) {
    functions.insert((*match)[1]);
  }
  return functions;
}

TEST(Pages, DescribeTheFunctionsOfEntries) {
  struct Entry {
    const char* name;
    const char* header;
    const char* page;
  };
  for (const Entry& entry :
       {Entry{"PlannerEntry", "include/trackbed/planning/common/planner.h", "add-a-planner.md"},
        Entry{"ControllerEntry", "include/trackbed/control/steering_controller.h",
              "add-a-controller.md"}}) {
    std::ostringstream page;
    page << std::ifstream(kFolder / "docs/how-to" / entry.page).rdbuf();
    const std::set<std::string> functions = FunctionsOf(entry.name, entry.header);
    EXPECT_GT(functions.size(), 5U) << entry.name;
    for (const std::string& function : functions) {
      EXPECT_THAT(page.str(), testing::AnyOf(testing::HasSubstr("`" + function + "`"),
                                             testing::HasSubstr("." + function + " = ")))
          << entry.page;
    }
  }
}

}  // namespace
