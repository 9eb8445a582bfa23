#include "tests/support/wrong_number.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>

#include "tests/support/processor_time.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Reads a path file and fits the path. Expects at most two seconds of processor time, and either a
/// path or an error message.
void ExpectBounded(const fs::path& file, PathFit fit) {
  const double begun = ProcessorTime();
  try {
    const FittedPath fitted = FitPath(ReadPathFile(file).points, {.fit = fit});
    EXPECT_LE(fitted.path.length(), 2.0 * kMaxPathLength);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()), "");
  }
  EXPECT_LE(ProcessorTime() - begun, 2.0);
}

TEST(PathWithAWrongNumber, EndsInTime) {
  const fs::path paths = fs::path(TRACKBED_SOURCE_DIR) / "tests/data/paths";
  const TempFolder folder;
  std::mt19937_64 random(4);
  for (const char* name :
       {"raceline.csv", "line.geojson", "nav_path.json", "nav_path.yaml", "commonroad.xml"}) {
    const std::string text = ReadFile(paths / name);
    for (int i = 0; i < 40; ++i) {
      SCOPED_TRACE(name + std::string(", slip ") + std::to_string(i));
      const fs::path file = folder.Write(name, WithWrongNumber(text, 0, random));
      ExpectBounded(file, PathFit::kSpline);
      ExpectBounded(file, PathFit::kPolyline);
    }
  }
}

/// Returns the line and message of the problem that fitting a CSV file reports; empty if the fit
/// succeeds.
std::string FitError(const std::string& csv) {
  const TempFolder folder;
  try {
    static_cast<void>(FitPath(ReadPathFile(folder.Write("p.csv", csv)).points, {}));
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    return std::to_string(problem.line) + ": " + problem.message;
  }
  return "";
}

TEST(PathThatIsTooLong, NamesTheRowsOfItsLargestGap) {
  EXPECT_EQ(FitError("x_m,y_m\n0,0\n1e6,0\n"),
            "3: the path is 1000000 m long; must be at most 200000 m: the gap between rows 2 and 3 "
            "is 1000000 m; correct the point or the unit of the positions, or divide the path");
  EXPECT_EQ(FitError("x_m,y_m\n0,0\n\n10,0\n20,1\n300000,0\n"),
            "6: the path is 300000 m long; must be at most 200000 m: the gap between rows 5 and 6 "
            "is 299980 m; correct the point or the unit of the positions, or divide the path");
}

}  // namespace
}  // namespace trackbed
