#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/folder_content.h"
#include "trackbed/core/file.h"

// The bytes of a result do not depend on how the path of a scenario is written, and no result holds
// a path of this machine.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

const fs::path kSourceTree = TRACKBED_SOURCE_DIR;

/// The shipped scenarios that read other files, as paths below the folder of the scenarios.
constexpr std::array kFileReaders{"real/dart_ramp_02",
                                  "real/dart_ramp_neg03",
                                  "real/dart_steering",
                                  "real/dart_free_driving_a",
                                  "real/dart_free_driving_b",
                                  "playback_lane_change",
                                  "paths/from_a_file",
                                  "roads/crossing",
                                  "roads/hill_pass",
                                  "old_town",
                                  "depot",
                                  "tracks/f1tenth_lap",
                                  "tracks/kidney_at_the_limit",
                                  "tracks/kidney_center",
                                  "tracks/kidney_minimum_curvature",
                                  "tracks/kidney_obstacle",
                                  "validation/braking",
                                  "validation/lane_change",
                                  "validation/step_steer"};

// Runs do not have to reach their goals.
constexpr const char* kQuick = "--plant kinematic --set drive.time_limit=0.2 expect={} ";

/// Returns the names of the files that differ or exist in only one of the folders.
std::vector<std::string> DifferingFiles(const std::map<std::string, std::string>& one,
                                        const std::map<std::string, std::string>& other) {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : one) {
    const auto found = other.find(name);
    if (found == other.end() || found->second != bytes) {
      names.push_back(name);
    }
  }
  for (const auto& [name, bytes] : other) {
    if (!one.contains(name)) {
      names.push_back(name);
    }
  }
  return names;
}

void ExpectNoLocalPaths(const std::map<std::string, std::string>& files, const fs::path& folder) {
  for (const auto& [name, bytes] : files) {
    for (const std::string& path : {folder.string(), kSourceTree.string()}) {
      EXPECT_EQ(bytes.find(path), std::string::npos) << name << " holds " << path;
    }
  }
}

class Spellings : public testing::TestWithParam<const char*> {};

TEST_P(Spellings, OfAPathGiveTheSameBytes) {
  const TempFolder folder;
  const std::string name = GetParam();
  const fs::path file = kSourceTree / "scenarios" / (name + ".yaml");
  const std::string inside = file.parent_path().string();
  const std::string base = file.filename().string();
  const std::string parent = file.parent_path().filename().string();
  fs::create_directory_symlink(kSourceTree / "scenarios", folder.path() / "link");
  fs::create_directories(folder.path() / "a/b");
  // Each way is a working folder and the path of the file from this folder.
  std::vector<std::pair<std::string, std::string>> ways{{".", file.string()},
                                                        {inside, base},
                                                        {inside, "./" + base},
                                                        {inside, "../" + parent + "//./" + base},
                                                        {"/", file.string().substr(1)},
                                                        {".", "link/" + name + ".yaml"},
                                                        {"a/b", "../../link/" + name + ".yaml"}};
  if (!name.starts_with("validation/")) {  // these scenarios cannot be found by their names
    ways.emplace_back(".", fs::path(name).filename().string());
  }
  std::map<std::string, std::string> first;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const auto& [from, spelling] = ways[i];
    const Outcome outcome =
        Shell(folder, "cd '" + from + "' && " TRACKBED_PROGRAM " run -q '" + spelling + "' -o '" +
                          (folder.path() / "out" / std::to_string(i)).string() + "' " + kQuick);
    ASSERT_TRUE(outcome.code == 0 || outcome.code == 3) << spelling << "\n" << outcome.output;
    const auto files = BytesOf(folder.path() / "out" / std::to_string(i));
    if (i == 0) {
      first = files;
      ASSERT_TRUE(first.contains("metrics.json"));
      ASSERT_TRUE(first.contains("manifest.json"));
      ExpectNoLocalPaths(first, folder.path());
    }
    EXPECT_THAT(DifferingFiles(first, files), testing::IsEmpty()) << spelling;
  }
}

std::string SpelledName(const testing::TestParamInfo<const char*>& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Spellings, testing::ValuesIn(kFileReaders), SpelledName);

TEST(SpellingsTest, HasAllShippedScenariosThatReadFiles) {
  const std::regex reads(R"((^|[ {,])(file|road_network|map): )");
  for (const auto& entry : fs::recursive_directory_iterator(kSourceTree / "scenarios")) {
    const fs::path file = entry.path();
    const std::string name =
        file.lexically_relative(kSourceTree / "scenarios").replace_extension().string();
    if (file.extension() != ".yaml" || name.starts_with("studies/") || name.starts_with("maps/") ||
        name.find("maps/") != std::string::npos || name.find("identify") != std::string::npos) {
      continue;
    }
    if (std::regex_search(ReadFile(file), reads)) {
      EXPECT_NE(std::find(kFileReaders.begin(), kFileReaders.end(), name), kFileReaders.end())
          << name;
    }
  }
}

TEST(SpellingsTest, OfRunsGiveTheSameComparison) {
  const TempFolder folder;
  for (const char* run : {"three_turns -o runs/a", "winding -o runs/b"}) {
    ASSERT_EQ(Trackbed(folder, "run " + std::string(run) +
                                   " -q --plant kinematic --set drive.time_limit=0.2 expect={}")
                  .code,
              3);  // the run ends before the goal
  }
  fs::create_directory_symlink(folder.path() / "runs", folder.path() / "link");
  const std::string here = folder.path().string();
  const std::vector<std::string> ways{"runs/a runs/b", here + "/runs/a " + here + "/runs/b/",
                                      "./runs/../runs/a link/b", "link/a/. runs//b"};
  std::map<std::string, std::string> first;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const std::string out = "out" + std::to_string(i);
    ASSERT_EQ(Trackbed(folder, "compare -q " + ways[i] + " -o " + out).code, 0);
    const auto files = BytesOf(folder.path() / out);
    first = i == 0 ? files : first;
    ExpectNoLocalPaths(files, folder.path());
    EXPECT_THAT(DifferingFiles(first, files), testing::IsEmpty()) << ways[i];
    EXPECT_EQ(Trackbed(folder, "report " + out).code, 0);
  }
}

// The run folder has a copy of the car, so that the resolved scenario runs anywhere.
TEST(SpellingsTest, OfAModelGiveTheSameBytesAlsoElsewhere) {
  const TempFolder folder;
  fs::copy(kSourceTree / "models/prius", folder.path() / "cars", fs::copy_options::recursive);
  fs::rename(folder.path() / "cars/prius.xml", folder.path() / "cars/mine.xml");
  fs::create_directory_symlink(folder.path() / "cars", folder.path() / "link");
  fs::copy(ScenarioFile("hit_the_box"), folder.path() / "s.yaml");
  const std::string here = folder.path().string();
  const std::string quick =
      " -q --plant mujoco --set drive.time_limit=0.2 expect={} 'disturb={payload: {mass: 50, x: 1, "
      "y: 0, z: 0.5}}' vehicle.steering_rate=0.5 vehicle.model=";
  const std::vector<std::string> ways{"cars/mine.xml", "./cars/../cars/mine.xml",
                                      here + "/cars/mine.xml", "link/mine.xml"};
  std::map<std::string, std::string> first;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const std::string out = "out" + std::to_string(i);
    const Outcome outcome =
        Trackbed(folder, "run s.yaml -o " + out + quick + ways[i] + " --allow-assets " + here);
    ASSERT_TRUE(outcome.code == 0 || outcome.code == 3) << outcome.output;
    const auto files = BytesOf(folder.path() / out);
    first = i == 0 ? files : first;
    ASSERT_TRUE(first.contains("vehicle.xml"));
    ExpectNoLocalPaths(files, folder.path());
    EXPECT_THAT(DifferingFiles(first, files), testing::IsEmpty()) << ways[i];
  }
  fs::remove_all(folder.path() / "cars");
  fs::rename(folder.path() / "out0", folder.path() / "moved");
  const Outcome again = Trackbed(folder, "run -q moved/scenario.resolved.yaml -o again");
  ASSERT_TRUE(again.code == 0 || again.code == 3) << again.output;
  EXPECT_THAT(DifferingFiles(first, BytesOf(folder.path() / "again")), testing::IsEmpty());
}

TEST(SpellingsTest, OfALogGiveTheSameImport) {
  const TempFolder folder;
  fs::copy(kSourceTree / "tests/data/dart/ramp_steer_02.csv", folder.path() / "log.csv");
  fs::copy(kSourceTree / "scenarios/real/maps/dart.yaml", folder.path() / "map.yaml");
  const std::string here = folder.path().string();
  const std::vector<std::string> ways{
      "import log.csv --map map.yaml", "import ./log.csv --map " + here + "/map.yaml",
      "import " + here + "/log.csv --map ./../" + folder.path().filename().string() + "/map.yaml"};
  std::map<std::string, std::string> first;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const std::string out = "out" + std::to_string(i);
    const Outcome outcome = Trackbed(folder, ways[i] + " --vehicle dart -q -o " + out);
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const auto files = BytesOf(folder.path() / out);
    first = i == 0 ? files : first;
    ExpectNoLocalPaths(files, folder.path());
    EXPECT_THAT(DifferingFiles(first, files), testing::IsEmpty()) << ways[i];
  }
}

// A link in the path of a study makes no difference.
TEST(SpellingsTest, OfAStudyGiveTheSameBytes) {
  const TempFolder folder;
  folder.Write("real/s.yaml", ReadFile(kSourceTree / "scenarios/winding.yaml"));
  folder.Write("real/study.yaml",
               "schema: 1\nname: study\nscenario: s.yaml\n"
               "set: {drive.time_limit: 0.1, drive.plants: [kinematic], expect: {}}\n"
               "vary: {mission.speed: [1, 2]}\noutputs: [metrics.kinematic.distance]\n");
  fs::create_directory_symlink("real", folder.path() / "link");
  const std::string absolute = (folder.path() / "real/study.yaml").string();
  std::map<std::string, std::string> first;
  for (const std::string& path :
       {absolute, std::string("real/study.yaml"), std::string("link/../link/study.yaml")}) {
    ASSERT_EQ(Trackbed(folder, "sweep -q " + path + " -o out").code, 0) << path;
    std::map<std::string, std::string> files = BytesOf(folder.path() / "out");
    if (first.empty()) {
      first = files;
    }
    EXPECT_THAT(DifferingFiles(first, files), testing::IsEmpty()) << path;
  }
}

}  // namespace
}  // namespace trackbed
