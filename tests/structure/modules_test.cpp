#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

struct Module {
  std::string path;                  // "planning/search"
  std::vector<std::string> parts{};  // its folders, such as "planning/grid"; `path` if empty
  std::vector<std::string> uses{};   // paths of modules
  std::vector<std::string> libraries{};
  std::vector<std::string> private_libraries{};

  /// The target of a module without the prefix: "planning_search".
  [[nodiscard]] std::string name() const {
    std::string name = path;
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
  }

  struct Folder {
    fs::path headers;
    fs::path sources;
  };

  [[nodiscard]] std::vector<Folder> folders() const {
    std::vector<Folder> folders;
    for (const std::string& part : parts.empty() ? std::vector{path} : parts) {
      folders.push_back({.headers = kRoot / "include" / "trackbed" / part,
                         .sources = part == "render" ? kRoot / "render" : kRoot / "src" / part});
    }
    return folders;
  }

  /// All existing folders with headers or sources.
  [[nodiscard]] std::vector<fs::path> places() const {
    std::vector<fs::path> places;
    for (const Folder& folder : folders()) {
      for (const fs::path& place : {folder.headers, folder.sources}) {
        if (fs::exists(place)) {
          places.push_back(place);
        }
      }
    }
    return places;
  }
};

/// The modules declared in CMakeLists.txt, from the bottom up.
std::vector<Module> Modules() {
  std::vector<Module> modules;
  const std::string build = ReadText(kRoot / "CMakeLists.txt");
  const std::regex declaration(R"(\btrackbed_module\(([^)]*)\))");
  for (std::sregex_iterator it(build.begin(), build.end(), declaration), end; it != end; ++it) {
    std::istringstream words((*it)[1]);
    Module module;
    words >> module.path;
    std::string keyword;
    for (std::string word; words >> word;) {
      if (std::regex_match(word, std::regex("[A-Z_]+"))) {
        keyword = word;
      } else if (keyword == "FOLDERS") {
        module.parts.push_back(word);
      } else if (keyword == "MODULES") {
        module.uses.push_back(word);
      } else if (keyword == "LIBRARIES") {
        module.libraries.push_back(word);
      } else if (keyword == "PRIVATE_LIBRARIES" && !word.starts_with("$<BUILD_INTERFACE:")) {
        module.private_libraries.push_back(word);
      }
    }
    modules.push_back(std::move(module));
  }
  return modules;
}

struct Include {
  fs::path file;
  std::string name;
};

std::vector<Include> FindIncludes(const Module& module) {
  std::vector<Include> includes;
  const std::regex line_pattern(R"re(^\s*#include\s+[<"]([^>"]+)[>"])re");
  for (const fs::path& place : module.places()) {
    for (const auto& entry : fs::recursive_directory_iterator(place)) {
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

// The build (cmake/Module.cmake) lets the compiler find only the headers of modules that a module
// links. However, MuJoCo's headers are visible to every target.
TEST(Modules, OnlySimAndRenderIncludeMujoco) {
  std::size_t seen = 0;
  for (const Module& module : Modules()) {
    for (const Include& include : FindIncludes(module)) {
      if (include.name.starts_with("mujoco/")) {
        ++seen;
        EXPECT_TRUE(module.path == "sim" || module.path == "render") << include.file;
        EXPECT_EQ(include.file.string().find("/include/"), std::string::npos)
            << include.file << ": a public header must not need MuJoCo's";
      }
    }
  }
  EXPECT_GT(seen, 5U);  // the scan found the sources
}

// The registry entry of a planner contains everything that other modules need. Therefore the
// modules of scenarios and runs do not include headers of planners. Exceptions are a maneuver that
// measures the gates of lane changes, the loop that releases the throttle at these gates, the
// ground below a route over roads, the remedies of refused plans, which try hybrid A*, and the verb
// that checks a path file.
TEST(Modules, KnowPlannersByTheirEntriesAlone) {
  const std::vector<std::string> shared{"common/", "registry/", "replan/", "avoidance/"};
  const std::vector<std::pair<std::string, std::string>> exceptions{
      {"lane_change.cpp", "course/lane_change.h"},
      {"drive.cpp", "course/lane_change.h"},
      {"route_world.cpp", "lanes/route_ground.h"},
      {"plan_remedies.cpp", "grid/hybrid_astar.h"},
      {"check_path.cpp", "path_file/path_check.h"},
      {"check_path.cpp", "path_file/path_file_planner.h"},
      {"check_path.cpp", "path_file/steerable_fit.h"}};
  std::size_t seen = 0;
  for (const char* path : {"scenario", "drive", "analysis", "cli"}) {
    const Module module{.path = path};
    for (const Include& include : FindIncludes(module)) {
      const std::string prefix = "trackbed/planning/";
      if (!include.name.starts_with(prefix)) {
        continue;
      }
      const std::string header = include.name.substr(prefix.size());
      const bool is_shared =
          std::any_of(shared.begin(), shared.end(),
                      [&](const std::string& folder) { return header.starts_with(folder); });
      const bool is_exception =
          std::find(exceptions.begin(), exceptions.end(),
                    std::pair(include.file.filename().string(), header)) != exceptions.end();
      EXPECT_TRUE(is_shared || is_exception) << include.file << " includes " << include.name;
      ++seen;
    }
  }
  EXPECT_GT(seen, 20U);  // the scan found the sources
}

TEST(Modules, EveryPublicHeaderHasASourceOfTheSameName) {
  std::vector<Module::Folder> folders;
  for (const Module& module : Modules()) {
    for (const Module::Folder& folder : module.folders()) {
      folders.push_back(folder);
    }
  }
  EXPECT_GT(folders.size(), 20U);  // the scan found the folders
  for (const Module::Folder& folder : folders) {
    if (!fs::exists(folder.headers)) {
      continue;
    }
    for (const auto& entry : fs::directory_iterator(folder.headers)) {
      // Headers with only templates or plain values need no source file, and the build writes the
      // version.
      static const std::vector<std::string> kNoCode{"state",       "version",      "registry",
                                                    "planner",     "plan",         "metric_value",
                                                    "diagnostics", "method_rules", "mcap_format"};
      const std::string name = entry.path().stem().string();
      if (entry.is_directory() || name.ends_with("_options") ||
          std::find(kNoCode.begin(), kNoCode.end(), name) != kNoCode.end()) {
        continue;
      }
      EXPECT_TRUE(fs::exists(folder.sources / (name + ".cpp"))) << entry.path();
    }
  }
}

TEST(Modules, AreDrawnAsTheBuildLinksThem) {
  const std::string page = ReadText(kRoot / "docs/architecture.md");
  const std::size_t begin = page.find("flowchart TD", page.find("## Modules"));
  ASSERT_NE(begin, std::string::npos) << "docs/architecture.md has no diagram of the modules";
  std::istringstream diagram(page.substr(begin, page.find("```", begin) - begin));
  std::vector<std::string> drawn;
  std::string line;
  std::getline(diagram, line);
  while (diagram >> std::ws && std::getline(diagram, line)) {
    drawn.push_back(line);
  }
  std::vector<std::string> links;
  for (const Module& module : Modules()) {
    for (const std::string& used : module.uses) {
      links.push_back(module.name() + " --> " + Module{.path = used}.name());
    }
    EXPECT_NE(page.find("| `" + module.path), std::string::npos)
        << module.path << " is not in the table of modules";
  }
  EXPECT_THAT(drawn, testing::UnorderedElementsAreArray(links));
}

// Only one header defines the file names of a run folder; modules that can include it must not
// repeat the names.
TEST(RunFolder, ItsFilesAreNamedInOnePlaceAlone) {
  const std::vector<fs::path> owners{kRoot / "include/trackbed/analysis/run_folder.h",
                                     kRoot / "src/analysis/run_folder.cpp"};
  std::vector<std::string> names;  // in quotation marks: "plan.csv", ".state.csv"
  const std::regex name(R"re("\.?\w+\.[\w.]+")re");
  for (const fs::path& owner : owners) {
    std::istringstream text(ReadText(owner));
    for (std::string line; std::getline(text, line);) {
      if (std::smatch match; !line.starts_with("#") && std::regex_search(line, match, name)) {
        names.push_back(match[0]);
      }
    }
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"\"plan.csv\"", "\"run.mcap\"", "\".state.csv\""}));
  const std::vector<std::string> can_see{"analysis", "report", "testing", "render", "cli"};
  for (const Module& module : Modules()) {
    if (std::find(can_see.begin(), can_see.end(), module.path) == can_see.end()) {
      continue;
    }
    for (const fs::path& place : module.places()) {
      for (const auto& entry : fs::recursive_directory_iterator(place)) {
        const fs::path extension = entry.path().extension();
        if ((extension != ".h" && extension != ".cpp") ||
            std::find(owners.begin(), owners.end(), entry.path()) != owners.end()) {
          continue;
        }
        const std::string text = ReadText(entry.path());
        for (const std::string& literal : names) {
          EXPECT_EQ(text.find(literal), std::string::npos)
              << entry.path() << " has " << literal << "; run_folder.h names it";
        }
      }
    }
  }
}

/// Returns the sources below a folder that contain one of the texts, except the files `owners`.
std::vector<std::string> SourcesWith(const fs::path& folder, const std::vector<std::string>& texts,
                                     const std::vector<std::string>& owners) {
  std::vector<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_source = entry.path().extension() == ".h" || entry.path().extension() == ".cpp";
    if (!is_source || std::find(owners.begin(), owners.end(), name) != owners.end()) {
      continue;
    }
    const std::string source = ReadText(entry.path());
    if (std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
          return source.find(text) != std::string::npos;
        })) {
      found.push_back(name);
    }
  }
  return found;
}

// Print of terminal.h takes control characters out of names and texts.
TEST(Output, OfVerbsGoesThroughOneFunction) {
  EXPECT_THAT(
      SourcesWith("src/cli", {"fmt::print(", "std::cout", "std::cerr", "printf(", "fwrite("},
                  {"terminal.h"}),
      testing::IsEmpty());
  // Exceptions are the error messages of main.cpp, which must always be printed, and the progress
  // bar, which prints no text of inputs.
  EXPECT_THAT(SourcesWith("src/cli", {"fputs("}, {"main.cpp", "progress_bar.cpp"}),
              testing::IsEmpty());
}

// JsonValue of json_file.h checks types and ranges. sweep_records.cpp also asks whether a foreign
// file begins with a header, which must not throw.
TEST(Results, AreReadThroughOneReader) {
  for (const char* folder :
       {"src/analysis", "src/report", "src/cli", "src/falsify", "src/identify", "render"}) {
    EXPECT_THAT(SourcesWith(folder, {"json::parse(ReadFile", "json::parse(*json", "VisitJson("},
                            {"json_file.cpp"}),
                testing::IsEmpty())
        << folder;
  }
}

/// A table cell: "`core`, `world`", or "-" if empty.
std::string Cell(const std::vector<std::string>& words) {
  std::string cell;
  for (const std::string& word : words) {
    cell += (cell.empty() ? "`" : ", `") + word + "`";
  }
  return cell.empty() ? "-" : cell;
}

TEST(Modules, AreComponentsThatLinkWhatTheirPageSays) {
  const std::string page = ReadText(kRoot / "docs/how-to/embed.md");
  std::size_t rows = 0;
  for (const Module& module : Modules()) {
    std::vector<std::string> uses;
    for (const std::string& used : module.uses) {
      uses.push_back(Module{.path = used}.name());
    }
    const std::string name = module.name() == "cli" ? "cli_library" : module.name();
    const std::string row = "| `trackbed::" + name + "` | " + Cell(uses) + " | " +
                            Cell(module.libraries) + " | " + Cell(module.private_libraries) + " |";
    EXPECT_NE(page.find("\n" + row + "\n"), std::string::npos) << "there is no row\n" << row;
    ++rows;
  }
  EXPECT_GE(rows, 20U);
}

// Install.cmake names the headers that programs include; embed.md lists them.
TEST(Headers, ThatAreInstalledAreThoseOfThePage) {
  std::vector<std::string> installed;
  std::ifstream build(kRoot / "cmake/Install.cmake");
  const std::regex header(R"(^    (?:list\(APPEND public_headers )?([\w/]+\.h)\b.*)");
  for (std::string line; std::getline(build, line);) {
    if (std::smatch match; std::regex_match(line, match, header)) {
      installed.push_back(match[1]);
    }
  }
  std::vector<std::string> listed;
  std::ifstream page(kRoot / "docs/how-to/embed.md");
  const std::regex row(R"(^\| \[`trackbed/([\w/]+\.h)`\].*)");
  for (std::string line; std::getline(page, line);) {
    if (std::smatch match; std::regex_match(line, match, row)) {
      listed.push_back(match[1]);
      EXPECT_TRUE(fs::exists(kRoot / "include/trackbed" / listed.back())) << listed.back();
    }
  }
  EXPECT_GT(installed.size(), 10U);  // the scan found the list
  EXPECT_THAT(listed, testing::UnorderedElementsAreArray(installed));
}

// The examples on the pages equal those that the tests build (tests/package).
TEST(Pages, ShowTheirExamplesAsTheyAreBuilt) {
  struct Shown {
    const char* page;
    std::vector<const char*> files;
  };
  const std::vector<Shown> all{
      {"add-a-planner.md", {"own-methods/main.cpp", "own-methods/sidestep.cpp"}},
      {"add-a-controller.md", {"own-methods/main.cpp", "own-methods/feedforward.cpp"}},
      {"add-a-metric.md", {"own-methods/main.cpp", "own-methods/roll.cpp"}},
      {"add-a-plant.md", {"own-plant/own_plant.cpp"}}};
  for (const Shown& shown : all) {
    const std::string page = ReadText(kRoot / "docs/how-to" / shown.page);
    for (const char* file : shown.files) {
      const std::string example = ReadText(kRoot / "docs/examples" / file);
      ASSERT_FALSE(example.empty()) << file;
      EXPECT_NE(page.find("```cpp\n" + example + "```\n"), std::string::npos)
          << shown.page << " does not show " << file;
    }
  }
}

TEST(Tree, TopLevelTracksOnlyWhatBelongsThere) {
  const std::string command = "git -C '" + kRoot.string() + "' ls-tree --name-only HEAD 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string names;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    names += static_cast<char>(c);
  }
  if (pclose(pipe) != 0) {
    GTEST_SKIP() << "not a git repository: " << names;
  }
  const std::regex allowed(
      R"(\..*|[A-Z]+(\.md)?|CMakeLists\.txt|CMakePresets\.json|pyproject\.toml|)"
      "bench|cmake|docs|include|models|packaging|python|render|scenarios|scripts|src|tests");
  std::istringstream lines(names);
  for (std::string name; std::getline(lines, name);) {
    EXPECT_TRUE(std::regex_match(name, allowed))
        << name << " is tracked at the top level: remove it, or name it here";
  }
}

}  // namespace
