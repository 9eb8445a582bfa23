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

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

/// Paths that pages name although the tree does not contain them: files of examples, and of MuJoCo.
const std::vector<std::string> kElsewhere{"render/heading_line.h", "render/heading_line.cpp",
                                          "include/mujoco/mujoco.h"};

/// Folders from which pages name files.
constexpr std::array<const char*, 3> kRoots{".", "include", "include/trackbed"};

std::vector<fs::path> Pages() {
  std::vector<fs::path> pages{kRoot / "README.md", kRoot / "CONTRIBUTING.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / "docs")) {
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
                     [&](const char* root) { return fs::exists(kRoot / root / path); });
}

TEST(Pages, NameFilesThatExist) {
  std::size_t seen = 0;
  for (const fs::path& page : Pages()) {
    for (const std::string& path : PathsIn(page)) {
      ++seen;
      const bool is_elsewhere =
          std::find(kElsewhere.begin(), kElsewhere.end(), path) != kElsewhere.end();
      EXPECT_TRUE(is_elsewhere || Exists(path))
          << fs::relative(page, kRoot) << " names " << path << ", which does not exist";
    }
  }
  EXPECT_GT(seen, 100U);  // the scan found paths
}

std::string ReadText(const fs::path& file) {
  std::ostringstream read;
  read << std::ifstream(kRoot / file).rdbuf();
  return read.str();
}

/// Returns the fields of a struct, and the virtual functions of a class, that a header declares,
/// such as `check`. The function joins lines, so that a declaration may have several.
std::set<std::string> MembersOf(const std::string& type, const fs::path& header) {
  static const std::regex comment("//[^\n]*");
  static const std::regex virtual_function("\\bvirtual [^;{~]*?\\b(\\w+)\\(");
  static const std::regex pointer("\\(\\*(\\w+)\\)\\(");
  static const std::regex field("\\b(\\w+)(?: = [^;()]*|\\{\\})?;");
  const std::string text = ReadText(header);
  const std::size_t begin = text.find("\n" + type + " {");
  EXPECT_NE(begin, std::string::npos) << type;
  const std::string body =
      std::regex_replace(text.substr(begin, text.find("\n};", begin) - begin), comment, "");
  std::set<std::string> members;
  const auto collect = [&](const std::string& code, const std::regex& pattern) {
    for (std::sregex_iterator match(code.begin(), code.end(), pattern), end; match != end;
         ++match) {
      members.insert((*match)[1]);
    }
  };
  if (type.starts_with("class")) {
    collect(body, virtual_function);
  } else {
    collect(body, pointer);
    collect(body, field);
    members.erase("nullptr");
  }
  return members;
}

TEST(Pages, DescribeTheMembersOfEntries) {
  struct Entry {
    const char* type;
    const char* header;
    const char* page;
    std::size_t count;  // of members, at least: the scan found the members
  };
  for (const Entry& entry :
       {Entry{"struct PlannerEntry", "include/trackbed/planning/common/planner.h",
              "add-a-planner.md", 25},
        Entry{"struct ControllerEntry", "include/trackbed/control/steering_controller.h",
              "add-a-controller.md", 12},
        Entry{"class Plant", "include/trackbed/sim/plant.h", "add-a-plant.md", 12},
        Entry{"struct PlantEntry", "include/trackbed/sim/plant.h", "add-a-plant.md", 3},
        Entry{"struct MetricEntry", "include/trackbed/analysis/metric_registry.h",
              "add-a-metric.md", 7}}) {
    const std::string page = ReadText(fs::path("docs/how-to") / entry.page);
    const std::set<std::string> members = MembersOf(entry.type, entry.header);
    EXPECT_GE(members.size(), entry.count) << entry.type;
    for (const std::string& member : members) {
      EXPECT_THAT(page, testing::AnyOf(testing::HasSubstr("`" + member + "`"),
                                       testing::HasSubstr("." + member + " = ")))
          << entry.page;
    }
  }
}

}  // namespace
