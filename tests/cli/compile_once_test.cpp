// How often the program compiles a car with MuJoCo.

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

// This executable's own functions come before those of MuJoCo's shared library, which they call.
// Declared here, as only sim and render see MuJoCo's headers.
struct mjModel_;
struct mjVFS_;
extern "C" mjModel_* mj_loadXML(const char* file, const mjVFS_* vfs, char* error, int error_size) {
  using Load = mjModel_* (*)(const char*, const mjVFS_*, char*, int);
  static const auto load = reinterpret_cast<Load>(dlsym(RTLD_NEXT, "mj_loadXML"));
  ++compiled;
  return load(file, vfs, error, error_size);
}

// A model that is compiled in a process of its own is loaded here.
extern "C" mjModel_* mj_loadModel(const char* file, const mjVFS_* vfs) {
  using Load = mjModel_* (*)(const char*, const mjVFS_*);
  static const auto load = reinterpret_cast<Load>(dlsym(RTLD_NEXT, "mj_loadModel"));
  ++compiled;
  return load(file, vfs);
}

namespace trackbed {
namespace {

/// Runs the program in a process of its own, as it keeps the signals, and ends that with the number
/// of models compiled; with 99 if the program could not do it.
[[noreturn]] void RunAndExit(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  const int code = Main(static_cast<int>(arguments.size()), arguments.data());
  constexpr int kDidNotArrive = 3;  // in the time that these runs have
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

// The shell around the car is made from the compiled car: one model without obstacles, one with.
TEST_F(CompileOnce, ObstaclesTakeOneMoreModel) {
  EXPECT_EXIT(RunAndExit(Words("overtake", {"--mcap"})), testing::ExitedWithCode(2), "");
}

// Reports are made from the finished folder alone, by the model that lies in it: once without its
// looks, for the vehicle's parameters, and once with them, for the replay.
TEST_F(CompileOnce, WhatReadsTheRunFolderCompilesItsModel) {
  EXPECT_EXIT(RunAndExit(Words("three_turns", {"--mcap", "--report"})), testing::ExitedWithCode(3),
              "");
}

}  // namespace
}  // namespace trackbed
