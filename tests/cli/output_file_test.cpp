#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

// Tests that an option that names a file does not replace what the command reads, or results.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A verb whose option names a file, with its input `in`, which the command reads before.
struct WritingVerb {
  std::string name;
  std::string input;  ///< file of the project that becomes `in`
  std::string in;
  std::string arguments;  ///< up to the name of the written file
  std::string option;

  friend void PrintTo(const WritingVerb& verb, std::ostream* out) { *out << verb.name; }
};

const std::string kStopsSoon = " --set drive.time_limit=0.1 expect={} drive.plants=[kinematic]";

std::vector<WritingVerb> WritingVerbs() {
  const std::string car = "tests/data/models/small_car.xml";
  const std::string scenario = "scenarios/winding.yaml";
  return {{"adapt", car, "car.xml", "model car.xml --adapt --out ", "--out"},
          {"ggv", car, "car.xml", "model car.xml --ggv --out ", "--out"},
          {"save", car, "car.xml", "model car.xml --save ", "--save"},
          {"experiment", car, "car.xml",
           "experiment optimal_steering --vehicle car.xml --evaluations 20 --speeds 2 --searches "
           "crs2 --out ",
           "--out"},
          {"test", scenario, "s.yaml", "test s.yaml" + kStopsSoon + " --junit ", "--junit"},
          {"fmu", scenario, "s.yaml", "fmu s.yaml" + kStopsSoon + " --out ", "--out"},
          {"check_path", "scenarios/paths/bends.csv", "p.csv",
           "check-path p.csv --speed 3 --report ", "--report"},
          {"report", "tests/data/falsification/falsify_delay.csv", "study.csv",
           "report study.csv --out ", "--out"}};
}

class OutputFile : public testing::TestWithParam<WritingVerb> {};

INSTANTIATE_TEST_SUITE_P(Verbs, OutputFile, testing::ValuesIn(WritingVerbs()),
                         [](const auto& of) { return of.param.name; });

TEST_P(OutputFile, IsNotAnInput) {
  const WritingVerb& verb = GetParam();
  const TempFolder folder;
  const std::string text = ReadFile(fs::path(TRACKBED_SOURCE_DIR) / verb.input);
  folder.Write(verb.in, text);
  fs::create_directory(folder.path() / "below");
  fs::create_hard_link(folder.path() / verb.in, folder.path() / "twin");
  fs::create_symlink(folder.path() / verb.in, folder.path() / "link");
  for (const std::string& out : {verb.in, "./below/../" + verb.in, std::string("link"),
                                 std::string("twin"), (folder.path() / verb.in).string()}) {
    const Outcome outcome = Trackbed(folder, verb.arguments + out);
    EXPECT_EQ(outcome.code, 2) << out << ": " << outcome.output;
    EXPECT_THAT(outcome.output,
                AllOf(HasSubstr(verb.option), HasSubstr("is an input of this command, and would be "
                                                        "replaced; name another file")));
    EXPECT_EQ(ReadFile(folder.path() / verb.in), text) << out;
  }
}

TEST_P(OutputFile, IsNoResult) {
  const WritingVerb& verb = GetParam();
  const TempFolder folder;
  folder.Write(verb.in, ReadFile(fs::path(TRACKBED_SOURCE_DIR) / verb.input));
  ASSERT_EQ(Trackbed(folder, "plan -q " + ScenarioFile("winding") + " -o r").code, 0);
  for (const char* name : {"plan.csv", "manifest.json"}) {
    const std::string before = ReadFile(folder.path() / "r" / name);
    const Outcome outcome = Trackbed(folder, verb.arguments + "r/" + name);
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_THAT(outcome.output,
                HasSubstr(std::string("r/") + name + " is a file of the plan in its folder"));
    EXPECT_EQ(ReadFile(folder.path() / "r" / name), before);
  }
}

// A file of the user that nobody listed as an input, such as one that the scenario names.
TEST_P(OutputFile, IsNotAFileOfAnotherProgram) {
  const WritingVerb& verb = GetParam();
  const TempFolder folder;
  folder.Write(verb.in, ReadFile(fs::path(TRACKBED_SOURCE_DIR) / verb.input));
  folder.Write("mine.txt", "mine");
  fs::create_symlink("mine.txt", folder.path() / "mine_link");
  for (const char* out : {"mine.txt", "mine_link"}) {
    const Outcome outcome = Trackbed(folder, verb.arguments + out);
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_THAT(outcome.output,
                AllOf(HasSubstr(verb.option),
                      HasSubstr("is not a file that this option has written, or was edited since, "
                                "and would be replaced; name another file")));
    EXPECT_EQ(ReadFile(folder.path() / "mine.txt"), "mine");
  }
}

TEST_P(OutputFile, IsReplacedByTheNextOne) {
  const WritingVerb& verb = GetParam();
  if (verb.name == "fmu") {
    GTEST_SKIP() << "takes long; ExportFmu.WritesAnArchiveThatRunsByItself checks the mark";
  }
  const TempFolder folder;
  folder.Write(verb.in, ReadFile(fs::path(TRACKBED_SOURCE_DIR) / verb.input));
  folder.Write("out", "");  // such as mktemp makes
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome = Trackbed(folder, verb.arguments + "out");
    EXPECT_THAT(outcome.code, testing::AnyOf(0, 1, 3)) << outcome.output;
    EXPECT_GT(fs::file_size(folder.path() / "out"), 0U) << outcome.output;
  }
}

TEST(OutputFileTest, IsNoModelThatWasEditedSince) {
  const TempFolder folder;
  const std::string save = "model dart --save car.xml";
  ASSERT_EQ(Trackbed(folder, save).code, 0);
  std::string text = ReadFile(folder.path() / "car.xml");
  text.insert(text.find("<worldbody"), "<!-- my notes -->");
  folder.Write("car.xml", text);
  EXPECT_EQ(Trackbed(folder, save).code, 2);
  EXPECT_EQ(ReadFile(folder.path() / "car.xml"), text);
}

class OutputFilm : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Endings, OutputFilm, testing::Values("png", "mp4", "webp", "apng"),
                         [](const auto& ending) { return ending.param; });

TEST_P(OutputFilm, IsReplacedByTheNextOneUnlessItIsOfAnotherProgram) {
  const TempFolder folder;
  if (!HasVideo(folder)) {
    GTEST_SKIP() << "built without video";
  }
  ASSERT_EQ(Trackbed(folder, "run -q " + ScenarioFile("winding") + kStopsSoon + " -o r").code, 3);
  const std::string render = "render r --size 128x72 --fps 10 --out film." + GetParam() +
                             (GetParam() == "png" ? " --at 0.1" : "");
  ASSERT_EQ(Trackbed(folder, render).code, 0);
  const std::string film = ReadFile(folder.path() / ("film." + GetParam()));
  const Outcome again = Trackbed(folder, render);
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(ReadFile(folder.path() / ("film." + GetParam())), film);

  // Cut at its end, the film has no mark.
  const std::string other =
      GetParam() == "png" ? "\x89PNG" : film.substr(0, film.size() - 8) + "of a user";
  folder.Write("film." + GetParam(), other);
  const Outcome refused = Trackbed(folder, render);
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output, HasSubstr("is not a file that this option has written"));
  EXPECT_EQ(ReadFile(folder.path() / ("film." + GetParam())), other);
}

TEST(OutputFileTest, IsNoManualPageOfAnotherProgram) {
  const TempFolder folder;
  folder.Write("own/trackbed-run.1", ".TH mine 1\n");
  const Outcome refused = Trackbed(folder, "man own");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output, HasSubstr("own/trackbed-run.1 is not a file that this option has "
                                        "written"));
  EXPECT_EQ(ReadFile(folder.path() / "own/trackbed-run.1"), ".TH mine 1\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "own"), {}), 1);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(Trackbed(folder, "man pages").code, 0);
  }
  EXPECT_THAT(Trackbed(folder, "man own/trackbed-run.1").output,
              HasSubstr("cannot create the folder"));
}

// The manifest of another program is in nobody's way.
TEST(OutputFileTest, MayBeInAFolderOfAnotherProgram) {
  const TempFolder folder;
  folder.Write("manifest.json", R"({"name": "app"})");
  EXPECT_EQ(Trackbed(folder, "model dart --ggv --out ggv.csv").code, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "ggv.csv"));
}

}  // namespace
}  // namespace trackbed
