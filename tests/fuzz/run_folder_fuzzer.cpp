#include <array>
#include <nlohmann/json.hpp>

#include "tests/fuzz/target.h"
#include "trackbed/analysis/compare_runs.h"
#include "trackbed/analysis/run.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/report/report.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRun = "run";
constexpr const char* kComparison = "comparison";
constexpr const char* kStudy = "study";

struct ResultFile {
  const char* folder;
  const char* name;
};

constexpr std::array kFiles{
    ResultFile{kRun, run_folder::kMetricsJson}, ResultFile{kRun, run_folder::kPlanJson},
    ResultFile{kRun, run_folder::kPlanCsv},     ResultFile{kRun, run_folder::kScenarioYaml},
    ResultFile{kRun, "kinematic.csv"},          ResultFile{kComparison, run_folder::kCompareJson},
    ResultFile{kStudy, run_folder::kSweepCsv},  ResultFile{kStudy, run_folder::kSweepJson}};

/// Writes a run of one second, its comparison with itself and a study of two points, without
/// manifests, which would detect every change.
void WriteFolders() {
  const fs::path scenario = fuzz::Write(
      "corner.yaml",
      "schema: 1\nname: corner\nmission: {speed: 3, waypoints: [[0, 0], [20, 0], [20, 20]]}\n"
      "plan: {method: fillet}\ndrive: {plants: [kinematic], time_limit: 1}\n");
  WriteRunFolder(RunScenario(ReadScenario(scenario)), fuzz::Folder() / kRun);
  WriteComparison(CompareFolders({fuzz::Folder() / kRun, fuzz::Folder() / kRun}, {}, {}),
                  fuzz::Folder() / kComparison);
  const CheckedStudy study = CheckStudy(ReadStudy(
      fuzz::Write("study.yaml",
                  "schema: 1\nname: study\nscenario: corner.yaml\nvary: {mission.speed: [1, 2]}\n"
                  "outputs: [metrics.kinematic.distance]\n")));
  SweepRecords records = SweepRecords::InMemory(SweepHeader(study.points));
  RunRows(study.points, [&](const Scenario& point) { return DriveOnce(study, point); }, records,
          {});
  WriteSweep(records, {}, fuzz::Folder() / kStudy);
  for (const char* folder : {kRun, kComparison, kStudy}) {
    fs::remove(fuzz::Folder() / folder / run_folder::kManifest);
  }
}

}  // namespace
}  // namespace trackbed

/// Fuzzes a file of a result (the first byte selects it): writes the report and, for a run, a
/// comparison with itself.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  if (size == 0) {
    return 0;
  }
  [[maybe_unused]] static const bool written = (WriteFolders(), true);
  const ResultFile& file = kFiles[data[0] % kFiles.size()];
  const fs::path folder = fuzz::Folder() / file.folder;
  const fs::path kept = fuzz::Folder() / "kept";
  fs::rename(folder / file.name, kept);
  fuzz::Write(std::string(file.folder) + "/" + file.name, fuzz::Text(data + 1, size - 1));
  fuzz::Expect([&] { static_cast<void>(ReportPage(ReportData({folder}))); });
  if (file.folder == kRun) {
    fuzz::Expect([&] { static_cast<void>(CompareFolders({folder}, {}, {})); });
  }
  fs::rename(kept, folder / file.name);
  return 0;
}
