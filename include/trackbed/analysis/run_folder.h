#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The names of the files in the folders of runs, comparisons and studies, for everything that
/// writes or reads one. docs/cli.md says what each file holds.
namespace trackbed::run_folder {

// Of every result: the sizes and SHA-256 of its files.
inline constexpr const char* kManifest = "manifest.json";
// Hidden folders in it, while a result is written: see output_folder.h.
inline constexpr const char* kPartial = ".trackbed.partial";  ///< not complete yet
inline constexpr const char* kComplete =
    ".trackbed.complete";  ///< complete, being moved into place
// What the manifest calls the results.
inline constexpr const char* kRun = "run";
inline constexpr const char* kPlan = "plan";
inline constexpr const char* kComparison = "comparison";
inline constexpr const char* kStudy = "study";
inline constexpr const char* kIdentification = "identification";

// Of a run.
inline constexpr const char* kScenarioYaml = "scenario.resolved.yaml";
inline constexpr const char* kModelXml = "model.xml";
inline constexpr const char* kPlanCsv = "plan.csv";
inline constexpr const char* kPlanJson = "plan.json";
inline constexpr const char* kScheduleCsv = "schedule.csv";
inline constexpr const char* kConvergenceCsv = "convergence.csv";
inline constexpr const char* kTreeCsv = "tree.csv";
inline constexpr const char* kTimingJson = "timing.json";
inline constexpr const char* kMetricsJson = "metrics.json";
inline constexpr const char* kMcap = "run.mcap";

// Made from a finished run.
inline constexpr const char* kVideo = "video.mp4";
inline constexpr const char* kPicture = "picture.png";
inline constexpr const char* kReport = "report.html";  ///< of a comparison or a study, too

// Of a comparison; in the folder of the run itself if it compares that run's plants.
inline constexpr const char* kCompareCsv = "compare.csv";
inline constexpr const char* kCompareJson = "compare.json";

// Of a study.
inline constexpr const char* kSweepCsv = "sweep.csv";
inline constexpr const char* kSweepJson = "sweep.json";
/// Grows with the study, which goes on from it: SweepRecords.
inline constexpr const char* kSweepRecords = "sweep.records";

// Of a search, beside those.
inline constexpr const char* kFalsifyJson = "falsify.json";
inline constexpr const char* kCounterexample = "counterexample";  ///< the folder of its run
inline constexpr const char* kCounterexampleYaml = "counterexample.yaml";  ///< in that folder

// Of an identification.
inline constexpr const char* kIdentifyJson = "identify.json";
std::string ResidualsCsv(const std::string& record);  ///< <record>.residuals.csv

/// What a plan with a path may have beside plan.json.
inline constexpr std::array kPathFiles{kPlanCsv, kScheduleCsv, kConvergenceCsv, kTreeCsv};

// Of a plant, by its name in the registry: "mujoco:contact" has "mujoco-contact.csv". InputError
// for a name that would lead to another folder.

std::string LogCsv(const std::string& plant);    ///< <plant>.csv
std::string StateCsv(const std::string& plant);  ///< <plant>.state.csv
// Of the plans adopted during the run.
std::string NewPlansCsv(const std::string& plant);      ///< <plant>.plan.csv
std::string NewPlansJson(const std::string& plant);     ///< <plant>.plan.json
std::string NewPlansTreeCsv(const std::string& plant);  ///< <plant>.tree.csv

/// The plant whose StateCsv has this name; none for the name of another file. A plant that is not
/// in the registry is called as in its file's name.
std::optional<std::string> PlantOfStateCsv(const std::string& file_name);

/// Every name that the folder of a run may have, with those of the plants in the registry.
std::vector<std::string> AllNames();

/// `file` itself, of a run folder. InputError naming it if it does not exist, is a folder, or is a
/// link to something outside of the run folder, whose content must not come into a report; and if
/// the folder has a manifest, which folders of older versions have not, unless the file is the one
/// that it names. Reads the file for that.
std::filesystem::path RequireFile(const std::filesystem::path& file);

/// Made before the files of some folders are read, asked when all are: whether they are of one
/// result each, and not some of the one before and some of one that took its place meanwhile.
class Reading {
 public:
  explicit Reading(std::vector<std::filesystem::path> folders);
  /// InputError naming a folder whose manifest has changed.
  void RequireUnchanged() const;

 private:
  std::vector<std::filesystem::path> folders_;
  std::vector<std::string> manifests_;
};

}  // namespace trackbed::run_folder
