// Counts how often the program compiles a car with MuJoCo.

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/cli/main.h"

namespace {

int compiled = 0;

}  // namespace

// These functions of the executable take precedence over those of MuJoCo's shared library and call
// them. MuJoCo's types are declared here because only sim and render see its headers.
struct mjModel_;
struct mjVFS_;
extern "C" mjModel_* mj_loadXML(const char* file, const mjVFS_* vfs, char* error, int error_size) {
  using Load = mjModel_* (*)(const char*, const mjVFS_*, char*, int);
  static const auto load = reinterpret_cast<Load>(dlsym(RTLD_NEXT, "mj_loadXML"));
  ++compiled;
  return load(file, vfs, error, error_size);
}

// A model that a child process compiled is loaded here.
extern "C" mjModel_* mj_loadModel(const char* file, const mjVFS_* vfs) {
  using Load = mjModel_* (*)(const char*, const mjVFS_*);
  static const auto load = reinterpret_cast<Load>(dlsym(RTLD_NEXT, "mj_loadModel"));
  ++compiled;
  return load(file, vfs);
}

namespace trackbed {
namespace {

/// Runs the program in a child process, because it installs signal handlers. The child exits with
/// the number of compiled models, or with 99 if the program failed.
[[noreturn]] void RunAndExit(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  const int code = Main(static_cast<int>(arguments.size()), arguments.data());
  constexpr int kDidNotArrive = 3;  // within the runs' time limit
  std::_Exit(code == 0 || code == kDidNotArrive ? compiled : 99);
}

class CompileOnce : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> Words(const std::string& scenario,
                                               const std::vector<std::string>& more) const {
    std::vector<std::string> words{"trackbed",
                                   "run",
                                   ScenarioFile(scenario),
                                   "-q",
                                   "--set",
                                   "drive.time_limit=0.5",
                                   "--set",
                                   "expect={}",
                                   "-o",
                                   (folder_.path() / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  TempFolder folder_;
};

TEST_F(CompileOnce, RunCompilesItsCarOnceForAllPlantsAndFiles) {
  EXPECT_EXIT(RunAndExit(Words("three_turns", {})), testing::ExitedWithCode(1), "");
  EXPECT_EXIT(RunAndExit(Words("three_turns", {"--mcap"})), testing::ExitedWithCode(1), "");
}

// The scene with obstacles is built from the compiled car. The mass of a moving obstacle comes from
// its geom, so the scene is compiled with visual geoms and without them, to compare the masses.
TEST_F(CompileOnce, ObstaclesTakeTwoMoreModels) {
  EXPECT_EXIT(RunAndExit(Words("overtake", {"--mcap"})), testing::ExitedWithCode(3), "");
}

// Reports use only the finished folder and compile its model twice: without visual elements for the
// vehicle's parameters, and with visual elements for the replay.
TEST_F(CompileOnce, WhatReadsTheRunFolderCompilesItsModel) {
  EXPECT_EXIT(RunAndExit(Words("three_turns", {"--mcap", "--report"})), testing::ExitedWithCode(3),
              "");
}

}  // namespace
}  // namespace trackbed
