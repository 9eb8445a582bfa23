#include <array>
#include <nlohmann/json.hpp>

#include "tests/fuzz/target.h"
#include "trackbed/analysis/compare_runs.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/report/report.h"

namespace trackbed {
namespace {

constexpr std::array kFiles{run_folder::kMetricsJson, run_folder::kPlanJson, run_folder::kPlanCsv,
                            run_folder::kScenarioYaml, "kinematic.csv"};

/// The folder of a run of a second.
const std::filesystem::path& RunOfASecond() {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path own = fuzz::Folder() / "run";
    WriteRunFolder(
        RunMission(ParseScenario("schema: 1\nname: corner\n"
                                 "mission: {speed: 3, waypoints: [[0, 0], [20, 0], [20, 20]]}\n"
                                 "plan: {method: fillet}\n"
                                 "drive: {plants: [kinematic], time_limit: 1}\n",
                                 "corner.yaml", fuzz::Folder())),
        own);
    std::filesystem::remove(own / run_folder::kManifest);  // it tells of every change
    return own;
  }();
  return folder;
}

}  // namespace
}  // namespace trackbed

/// A file of a finished run, for its report and a comparison with itself: the first byte says
/// which.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  if (size == 0) {
    return 0;
  }
  const std::filesystem::path& run = RunOfASecond();
  const char* name = kFiles[data[0] % kFiles.size()];
  const std::filesystem::path kept = fuzz::Folder() / "kept";
  std::filesystem::rename(run / name, kept);
  fuzz::Write(std::string("run/") + name, fuzz::Text(data + 1, size - 1));
  fuzz::Expect([&] { static_cast<void>(ReportPage(ReportData({run}))); });
  fuzz::Expect([&] { static_cast<void>(CompareFolders({run}, {}, {})); });
  std::filesystem::rename(kept, run / name);
  return 0;
}
