#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace foreign_files_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kSource = TRACKBED_SOURCE_DIR;
// Ends each drive after 0.1 s.
const std::string kShort = " --set drive.time_limit=0.1 expect={}";

std::string StudyFile(const std::string& rest) {
  return "schema: 1\nname: study\nscenario: " + ScenarioFile("winding") +
         "\nset: {drive.plants: [kinematic], drive.time_limit: 0.1, expect: {metrics: [{metric: "
         "status, equals: goal_reached}]}}\n" +
         rest;
}

/// A verb that writes to a folder.
struct Verb {
  std::string name;
  std::string arguments;
  std::string out = "r";
  std::string before{};  ///< shell command that makes the input of the verb, in its output folder
                         ///< or elsewhere
  NameParts parts{};

  friend void PrintTo(const Verb& verb, std::ostream* to) { *to << verb.name; }
};

std::vector<Verb> Verbs() {
  return {
      {"run", "run " + ScenarioFile("winding") + " --plant kinematic -o r" + kShort},
      {"plan", "plan " + ScenarioFile("winding") + " -o r"},
      {"compare",
       "compare " + ScenarioFile("winding") + " --plants kinematic,single_track -o r" + kShort},
      {"import", "import " + kSource + "/tests/data/recordings/autoware.csv --map " + kSource +
                     "/scenarios/real/maps/autoware.yaml --vehicle " + kSource +
                     "/tests/data/models/small_car.xml -o r"},
      {"check-path", "check-path path.csv --speed 2 --drive -o r --plant kinematic" + kShort},
      {"sweep", "sweep sweep.yaml -o r"},
      {"sweep --restart", "sweep sweep.yaml -o r --restart"},
      {"sweep merge", "sweep merge shards -o r", "r",
       TRACKBED_PROGRAM " sweep -q sweep.yaml -o shards --shard 1/2 && " TRACKBED_PROGRAM
                        " sweep -q sweep.yaml -o shards --shard 2/2"},
      {"sweep submit", "sweep submit sweep.yaml --tasks 3 -o r"},
      {"falsify", "falsify falsify.yaml -o r --report"},
      {"verify", "verify verify.yaml -o r --probability 0.5"},
      {"identify",
       "identify identify.yaml -o r",
       "r",
       "",
       {{"vehicle", {"small_car"}}, {"record", {"autoware"}}}},
      {"report", "report r", "r",
       TRACKBED_PROGRAM " run -q " + ScenarioFile("winding") + " --plant kinematic -o r" + kShort},
      {"render", "render r --at 0", "r",
       TRACKBED_PROGRAM " run -q " + ScenarioFile("winding") + " --plant kinematic -o r" + kShort},
  };
}

/// Tests a verb in a folder that has files, or links, with the names that the verb writes.
class ForeignFiles : public testing::TestWithParam<std::tuple<Verb, bool>> {
 protected:
  ForeignFiles() {
    folder_.Write("path.csv", "x_m,y_m\n0,0\n10,0\n20,0\n");
    folder_.Write("sweep.yaml", StudyFile("vary: {mission.speed: [1, 2]}\nkeep: all\n"));
    folder_.Write("falsify.yaml",
                  StudyFile("vary: {mission.speed: {distribution: uniform, from: 1, to: 4}}\n"
                            "search: {runs: 2, shrink_runs: 0}\n"));
    folder_.Write("verify.yaml",
                  StudyFile("vary: {mission.speed: {distribution: uniform, from: 1, to: 2}}\n"
                            "sample: {count: 3, method: random}\n"));
    // A replacement for Slurm's sbatch.
    const fs::path sbatch = folder_.Write("bin/sbatch", "#!/bin/sh\necho 1\n");
    fs::permissions(sbatch, fs::perms::owner_all);
    if (verb().name == "identify") {
      MakeIdentification();
    }
    const Outcome made = Shell(folder_, verb().before.empty() ? "true" : verb().before);
    EXPECT_TRUE(made.code == 0 || made.code == 3) << made.output;
    if (fs::exists(out())) {
      fs::copy(out(), folder_.path() / "before", fs::copy_options::recursive);
    }
  }

  void MakeIdentification() const {
    const std::string import = Verbs()[3].arguments;
    const Outcome imported =
        Trackbed(folder_, import.substr(0, import.size() - std::string("r").size()) + "autoware");
    EXPECT_EQ(imported.code, 0) << imported.output;
    folder_.Write("identify.yaml",
                  "schema: 1\nname: study\nfit: [autoware/scenario.resolved.yaml]\n"
                  "parameters: [{name: yaw_inertia, from: 0.02, to: 0.2}]\nstarts: 1\n"
                  "evaluations: 1\nhorizon: 10\n");
  }

  [[nodiscard]] static const Verb& verb() { return std::get<0>(GetParam()); }
  [[nodiscard]] static bool is_link() { return std::get<1>(GetParam()); }
  [[nodiscard]] fs::path out() const { return folder_.path() / verb().out; }

  void Restore() const {
    fs::remove_all(out());
    if (fs::exists(folder_.path() / "before")) {
      fs::copy(folder_.path() / "before", out(), fs::copy_options::recursive);
    }
  }

  [[nodiscard]] Outcome Run() const {
    return Shell(folder_, "PATH=\"$PWD/bin:$PATH\" timeout 60 " TRACKBED_PROGRAM " " +
                              verb().arguments + " -q");
  }

  /// Returns the declared names of the verb's files and the names of the files that the verb
  /// writes, relative to its output folder.
  [[nodiscard]] std::vector<std::string> Names() const {
    const std::string name = verb().name.substr(0, verb().name.find(" --"));
    std::vector<std::string> names = FileNamesOfVerb(name, verb().parts);
    Restore();
    const Outcome whole = Run();
    EXPECT_TRUE(whole.code == 0 || whole.code == 3) << whole.output;
    for (const auto& entry : fs::recursive_directory_iterator(out())) {
      const fs::path written = entry.path().lexically_relative(out());
      if (entry.is_regular_file() && !fs::exists(folder_.path() / "before" / written)) {
        names.push_back(written);
      }
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
  }

  const TempFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Verbs, ForeignFiles,
                         testing::Combine(testing::ValuesIn(Verbs()), testing::Bool()),
                         [](const auto& test) {
                           std::string name = std::get<0>(test.param).name;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name + (std::get<1>(test.param) ? "_links" : "_files");
                         });

TEST_P(ForeignFiles, AreNeitherReplacedNorRemoved) {
  const std::string bytes = "mine\n";
  const fs::path target = folder_.Write("elsewhere", bytes);
  const std::vector<std::string> names = Names();
  EXPECT_FALSE(names.empty());
  for (const std::string& name : names) {
    Restore();
    const fs::path file = out() / name;
    fs::create_directories(file.parent_path());
    fs::remove(file);
    if (is_link()) {
      fs::create_symlink(target, file);
    } else {
      WriteFileAtomically(file, bytes);
    }
    const Outcome outcome = Run();
    const std::string what = name + ": " + outcome.output;
    EXPECT_EQ(fs::is_symlink(file), is_link()) << what;
    ASSERT_TRUE(fs::exists(file)) << what;
    EXPECT_EQ(ReadFile(file), bytes) << what;
    EXPECT_EQ(ReadFile(target), bytes) << what;
    // A refusal is one line that names the file.
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 2 || outcome.code == 3) << what;
    if (outcome.code == 2) {
      EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << what;
      EXPECT_THAT(outcome.output, HasSubstr(fs::path(name).filename().string())) << what;
    }
  }
}

// A folder that is named by the input is no link, whereas the folder of --out may be one.
TEST(OutputFolderOf, DoesNotFollowLinksNamedByTheInput) {
  const std::string scenario =
      "schema: 1\nname: mine\nmission: {speed: 1, waypoints: [[0, 0], "
      "[9, 0]]}\nplan: {method: dubins}\n";
  const std::string study =
      "schema: 1\nname: mine\nscenario: a.yaml\nset: {drive.plants: "
      "[kinematic]}\nvary: {mission.speed: {distribution: uniform, from: 1, "
      "to: 2}}\n";
  const TempFolder folder;
  folder.Write("a.yaml", scenario);
  folder.Write("b.yaml", "schema: 1\nname: other\n" + scenario.substr(scenario.find("mission")));
  folder.Write("mine.csv", "x_m,y_m\n0,0\n10,0\n20,0\n");
  folder.Write("sample.yaml", study + "sample: {count: 3, method: random}\n");
  folder.Write("search.yaml", study + "search: {runs: 2, shrink_runs: 0}\n");
  folder.Write("users/notes.txt", "mine");
  fs::create_directories(folder.path() / "out/compare");
  fs::create_directory(folder.path() / "several");
  for (const char* link : {"out/mine", "out/mine_verify", "out/compare/mine", "several/mine"}) {
    fs::create_directory_symlink(folder.path() / "users", folder.path() / link);
  }
  for (const char* arguments : {"run a.yaml", "run a.yaml b.yaml -o several", "plan a.yaml",
                                "watch a.yaml", "compare a.yaml --plants kinematic,single_track",
                                "compare a.yaml b.yaml --plants kinematic,single_track -o several",
                                "check-path mine.csv --speed 2 --drive", "sweep sample.yaml",
                                "falsify search.yaml", "verify sample.yaml --probability 0.5"}) {
    const Outcome refused = Trackbed(folder, arguments);
    EXPECT_EQ(refused.code, 2) << arguments;
    EXPECT_THAT(refused.output, HasSubstr("it is a link, not a folder")) << arguments;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "users"), {}), 1) << arguments;
  }
  const Outcome given = Trackbed(folder, "plan a.yaml -q -o out/mine");
  EXPECT_EQ(given.code, 0) << given.output;
}

// The user may have notes beside the results.
TEST_P(ForeignFiles, OfOtherNamesAreInNobodysWay) {
  const fs::path target = folder_.Write("elsewhere", "mine\n");
  Restore();
  Outcome outcome = Run();
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 3) << outcome.output;
  std::vector<fs::path> notes{out() / "notes.txt"};
  for (const auto& entry : fs::recursive_directory_iterator(out())) {
    if (entry.is_directory()) {
      notes.push_back(entry.path() / "notes.txt");
    }
  }
  for (const fs::path& note : notes) {
    if (is_link()) {
      fs::create_symlink(target, note);
    } else {
      WriteFileAtomically(note, "mine\n");
    }
  }
  for (int i = 0; i < 2; ++i) {
    outcome = Run();
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 3) << outcome.output;
    for (const fs::path& note : notes) {
      EXPECT_TRUE(fs::exists(note) && ReadFile(note) == "mine\n") << note;
    }
  }
}

}  // namespace foreign_files_test
}  // namespace trackbed
