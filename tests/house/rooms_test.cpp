#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = TRACKBED_SOURCE_DIR;

/// The rooms from the top of the house down, as the build declares them.
std::vector<std::string> Rooms() {
  std::ifstream file(kRoot / "CMakeLists.txt");
  std::vector<std::string> rooms;
  const std::regex declaration(R"(^\s*trackbed_room\((\w+))");
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_search(line, match, declaration)) {
      rooms.push_back(match[1]);
    }
  }
  return rooms;
}

std::vector<fs::path> FoldersOf(const std::string& room) {
  const fs::path sources = room == "render" ? kRoot / "render" : kRoot / "src" / room;
  return {kRoot / "include" / "trackbed" / room, sources};
}

struct Include {
  fs::path file;
  std::string name;
};

std::vector<Include> IncludesOf(const std::string& room) {
  std::vector<Include> includes;
  const std::regex line_pattern(R"re(^\s*#include\s+[<"]([^>"]+)[>"])re");
  for (const fs::path& folder : FoldersOf(room)) {
    if (!fs::exists(folder)) {
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") {
        continue;
      }
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        std::smatch match;
        if (std::regex_search(line, match, line_pattern)) {
          includes.push_back({entry.path(), match[1]});
        }
      }
    }
  }
  return includes;
}

TEST(Rooms, IncludeOnlyRoomsAboveThem) {
  const std::vector<std::string> rooms = Rooms();
  ASSERT_GE(rooms.size(), 10U);
  const std::regex room_pattern(R"(^(?:trackbed|src)/(\w+)/)");
  std::size_t seen = 0;
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const std::vector<std::string> reachable(rooms.begin(),
                                             rooms.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    for (const Include& include : IncludesOf(rooms[i])) {
      std::smatch match;
      if (!std::regex_search(include.name, match, room_pattern)) {
        continue;
      }
      ++seen;
      EXPECT_THAT(reachable, testing::Contains(match[1].str()))
          << include.file << " includes " << include.name << ", a room below";
    }
  }
  EXPECT_GT(seen, 50U);  // the scan saw the sources at all
}

TEST(Rooms, KeepTheirInnerHeadersToThemselves) {
  for (const std::string& room : Rooms()) {
    for (const Include& include : IncludesOf(room)) {
      EXPECT_FALSE(include.name.starts_with("bench/") || include.name.starts_with("tests/"))
          << include.file << " includes " << include.name;
      if (include.name.starts_with("src/") || include.name.starts_with("render/")) {
        const std::string own = room == "render" ? "render/" : "src/" + room + "/";
        EXPECT_TRUE(include.name.starts_with(own)) << include.file << " includes " << include.name;
      }
    }
  }
}

TEST(Rooms, OnlySimAndRenderKnowMujoco) {
  for (const std::string& room : Rooms()) {
    for (const Include& include : IncludesOf(room)) {
      if (include.name.starts_with("mujoco/")) {
        EXPECT_TRUE(room == "sim" || room == "render") << include.file;
        EXPECT_EQ(include.file.string().find("/include/"), std::string::npos)
            << include.file << ": a public header must not need MuJoCo's";
      }
    }
  }
}

TEST(Rooms, EveryPublicHeaderHasASourceOfTheSameName) {
  for (const std::string& room : Rooms()) {
    const auto folders = FoldersOf(room);
    if (!fs::exists(folders[0])) {
      continue;
    }
    for (const auto& entry : fs::directory_iterator(folders[0])) {
      const std::string name = entry.path().stem().string();
      // Plain structs need no code; the version is written by the build.
      if (name == "state" || name == "version") {
        continue;
      }
      EXPECT_TRUE(fs::exists(folders[1] / (name + ".cpp"))) << entry.path();
    }
  }
}

std::string TextOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// "a --> b" for every room a that the build links with room b.
std::vector<std::string> LinksOfTheBuild() {
  std::vector<std::string> links;
  const std::string build = TextOf(kRoot / "CMakeLists.txt");
  const std::regex declaration(R"(\btrackbed_room\(([^)]*)\))");
  for (std::sregex_iterator it(build.begin(), build.end(), declaration), end; it != end; ++it) {
    std::istringstream words((*it)[1]);
    std::string room;
    std::string keyword;
    words >> room;
    for (std::string word; words >> word;) {
      if (std::regex_match(word, std::regex("[A-Z_]+"))) {
        keyword = word;
      } else if (keyword == "ROOMS") {
        links.push_back(room + " --> " + word);
      }
    }
  }
  return links;
}

TEST(Pages, ShowTheirExamplesAsTheyAreBuilt) {
  const auto read = [](const fs::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  };
  const fs::path folder = kRoot / "docs" / "how-to";
  const std::string example = read(folder / "add_a_planner.cpp");
  ASSERT_FALSE(example.empty());
  EXPECT_NE(read(folder / "add-a-planner.md").find("```cpp\n" + example + "```\n"),
            std::string::npos);
}

TEST(Rooms, AreDrawnAsTheBuildLinksThem) {
  const std::string page = TextOf(kRoot / "docs/architecture.md");
  const std::size_t begin = page.find("flowchart BT");
  ASSERT_NE(begin, std::string::npos) << "docs/architecture.md has no diagram of the rooms";
  std::istringstream diagram(page.substr(begin, page.find("```", begin) - begin));
  std::vector<std::string> drawn;
  std::string line;
  std::getline(diagram, line);
  while (diagram >> std::ws && std::getline(diagram, line)) {
    drawn.push_back(line);
  }
  EXPECT_THAT(drawn, testing::UnorderedElementsAreArray(LinksOfTheBuild()));
  for (const std::string& room : Rooms()) {
    EXPECT_THAT(drawn, testing::Contains(testing::ContainsRegex("(^| )" + room + "( |$)")));
    EXPECT_NE(page.find("| `" + room), std::string::npos)
        << room << " is not in the table of rooms";
  }
}

}  // namespace
