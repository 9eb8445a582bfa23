#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <string>

#include "tests/cli/program.h"
#include "tests/support/folder_content.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Scenarios that cover random numbers, searches and additional input files: RRT* during the run,
/// an RRT route in wind, noise and kicks, Frenet motions around a moving car, and a recording.
constexpr std::array kScenarios{"obstacle_appears", "windy_field", "disturbed", "overtake",
                                "playback_lane_change"};

/// Names of files that differ or exist in only one of the maps; the contents are too long to print.
std::string Differing(const std::map<std::string, std::string>& one,
                      const std::map<std::string, std::string>& other) {
  std::string names;
  for (const auto& [name, bytes] : one) {
    const auto found = other.find(name);
    names += found != other.end() && found->second == bytes ? "" : name + "\n";
  }
  for (const auto& [name, bytes] : other) {
    names += one.contains(name) ? "" : name + "\n";
  }
  return names;
}

struct Way {
  const char* name;
  /// Runs the scenarios into the folder `other`; exit code 77: not possible on this machine.
  const char* script;
};

// `$run` is the program with its options, `$here` the folder of the scenarios.
constexpr std::array kWays{
    Way{"again", "cd \"$here\" && $run *.yaml -o ../other"},
    Way{"one by one, from elsewhere",
        "mkdir -p else/where/scenarios && cd else/where && cp \"$here\"/* scenarios && "
        "for name in $(ls -r \"$here\" | sed -n 's/.yaml$//p'); do "
        "$run scenarios/$name.yaml -o ../../other/$name || exit; done"},
    Way{"without ASLR",
        "setarch -R true || exit 77; cd \"$here\" && setarch -R $run *.yaml -o ../other"},
    Way{"in another environment",
        "cd \"$here\" && umask 077 && env -i HOME=/nonexistent TZ=Asia/Kathmandu LD_BIND_NOW=1 "
        "MALLOC_PERTURB_=165 COLUMNS=40 $run *.yaml -o ../other"},
    Way{"with a decimal comma",
        "localedef -i de_DE -f UTF-8 ./de_DE.UTF-8; export LOCPATH=$PWD LC_ALL=de_DE.UTF-8; "
        "[ \"$(locale decimal_point)\" = , ] || exit 77; cd \"$here\" && $run *.yaml -o ../other"},
};

class Repeats : public testing::TestWithParam<Way> {};

TEST_P(Repeats, ToTheSameBytes) {
  const TempFolder folder;
  fs::create_directory(folder.path() / "scenarios");
  for (const char* name : kScenarios) {
    fs::copy(ScenarioFile(name), folder.path() / "scenarios");
  }
  fs::copy(fs::path(ScenarioFile("playback_lane_change")).replace_extension(".csv"),
           folder.path() / "scenarios");
  const std::string run =
      "here=$PWD/scenarios; run='" TRACKBED_PROGRAM " run -q --mcap --report'; ";
  const Outcome first = Shell(folder, run + "cd scenarios && $run *.yaml -o ../first");
  ASSERT_EQ(first.code, 0) << first.output;
  const Outcome other = Shell(folder, run + GetParam().script);
  if (other.code == 77) {
    GTEST_SKIP() << "not possible here: " << other.output;
  }
  ASSERT_EQ(other.code, 0) << other.output;
  const auto bytes = BytesOf(folder.path() / "first");
  EXPECT_EQ(bytes.size(), 74U);
  EXPECT_EQ(Differing(bytes, BytesOf(folder.path() / "other")), "");
}

std::string WayName(const testing::TestParamInfo<Way>& tested) {
  std::string name;
  for (const char c : std::string(tested.param.name)) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Ways, Repeats, testing::ValuesIn(kWays), WayName);

}  // namespace
}  // namespace trackbed
