#include <algorithm>

#include "tests/fuzz/target.h"
#include "trackbed/scenario/study_points.h"
#include "trackbed/scenario/study_reader.h"

/// Fuzzes a study of a valid scenario.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  static const std::filesystem::path scenario = fuzz::Write(
      "scenario.yaml",
      "schema: 1\nname: corner\nmission: {speed: 3, waypoints: [[0, 0], [40, 0], [40, 40]]}\n"
      "plan: {method: fillet}\n");
  const std::filesystem::path file = fuzz::Write("study.yaml", fuzz::Text(data, size));
  return fuzz::Expect([&] {
    const Study study = ReadStudy(file);
    // A study may have thousands of points, which are all checked in the same way.
    constexpr std::size_t kFewPoints = 50;
    const StudyPoints points(study);
    for (std::size_t i = 0; i < std::min(points.size(), kFewPoints); ++i) {
      static_cast<void>(points.Read(i));
    }
  });
}
