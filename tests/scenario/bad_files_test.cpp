#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/scenario/study_check.h"
#include "trackbed/scenario/study_reader.h"
#include "trackbed/sim/car_model.h"

/// Every tests/data/bad/SECTION/NAME.yaml has one fault, and NAME.expected holds the exact message.
/// If NAME.expected is missing, the test prints its required content. Files that the scenarios name
/// are in tests/data/bad.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNoError = "no error";

fs::path BadFolder() {
  return fs::path(TRACKBED_SOURCE_DIR) / "tests" / "data" / "bad";
}

std::vector<fs::path> FilesWith(const std::string& extension) {
  std::vector<fs::path> files;
  std::error_code none;  // without files, the last test fails
  for (const auto& entry : fs::recursive_directory_iterator(BadFolder(), none)) {
    if (entry.path().extension() == extension) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Messages contain the folder of the file, which differs between machines.
std::string WithoutFolder(std::string message, const fs::path& file) {
  for (const fs::path& path : {file.parent_path(), BadFolder()}) {
    const std::string folder = path.string() + "/";
    for (std::size_t at = message.find(folder); at != std::string::npos;
         at = message.find(folder)) {
      message.erase(at, folder.size());
    }
  }
  return message;
}

/// Returns the message for a file, from the reader or from loading the car that the file names. A
/// file with the key `scenario` is a study.
std::string MessageFor(const fs::path& file) {
  try {
    if (IsStudy(file)) {
      CheckPoints(StudyPoints(ReadStudy(file)), true);
      return kNoError;
    }
    const Scenario scenario = ParseScenario(ReadFile(file), file.filename().string(), BadFolder());
    const fs::path model = FindModel(scenario.vehicle.model, scenario.folder);
    const CarModel car(ComposeScene(model, {.timestep = scenario.drive.timestep}), model.string());
  } catch (const InputError& error) {
    return WithoutFolder(error.what(), file);
  }
  return kNoError;
}

class BadFiles : public testing::TestWithParam<fs::path> {};

INSTANTIATE_TEST_SUITE_P(Files, BadFiles, testing::ValuesIn(FilesWith(".yaml")),
                         [](const auto& file) { return file.param.stem().string(); });

TEST_P(BadFiles, SayWhatIsWrong) {
  const std::string message = MessageFor(GetParam());
  EXPECT_NE(message, kNoError);
  const fs::path expected = fs::path(GetParam()).replace_extension(".expected");
  ASSERT_TRUE(fs::is_regular_file(expected)) << "the message is now:\n" << message;
  EXPECT_EQ(message + "\n", ReadFile(expected));
}

TEST(BadFilesFolder, HoldsManyFilesEachWithItsMessage) {
  EXPECT_GE(FilesWith(".yaml").size(), 150U);
  EXPECT_EQ(FilesWith(".yaml").size(), FilesWith(".expected").size());
}

}  // namespace
}  // namespace trackbed
