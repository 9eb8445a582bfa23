#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The names of the files in the folders of runs, comparisons and studies. docs/cli.md describes
/// the files.
namespace trackbed::run_folder {

// Manifest of every result, with the sizes and SHA-256 of its files.
inline constexpr const char* kManifest = "manifest.json";
// Hidden folders in the output folder while a result is written (see output_folder.h).
/// Folder of a result that is not complete yet.
inline constexpr const char* kPartial = ".trackbed.partial";
/// Folder of a complete result that is being moved into place.
inline constexpr const char* kComplete = ".trackbed.complete";
// Names of the results in the manifest.
inline constexpr const char* kRun = "run";
inline constexpr const char* kPlan = "plan";
inline constexpr const char* kComparison = "comparison";
inline constexpr const char* kStudy = "study";
inline constexpr const char* kIdentification = "identification";
inline constexpr const char* kFalsification = "falsification";
inline constexpr const char* kVerification = "verification";
inline constexpr const char* kSubmission = "submission";

// Files of a run.
inline constexpr const char* kScenarioYaml = "scenario.resolved.yaml";
inline constexpr const char* kModelXml = "model.xml";
inline constexpr const char* kPlanCsv = "plan.csv";
inline constexpr const char* kPlanJson = "plan.json";
inline constexpr const char* kScheduleCsv = "schedule.csv";
inline constexpr const char* kTreeCsv = "tree.csv";
inline constexpr const char* kTimingJson = "timing.json";
inline constexpr const char* kMetricsJson = "metrics.json";
inline constexpr const char* kMcap = "run.mcap";

// Files made from a finished run.
inline constexpr const char* kVideo = "video.mp4";
inline constexpr const char* kPicture = "picture.png";
inline constexpr const char* kReport = "report.html";  ///< Report of a run, comparison or study.

// Files of a comparison. The plants of one run are compared in the folder of that run.
inline constexpr const char* kCompareCsv = "compare.csv";
inline constexpr const char* kCompareJson = "compare.json";

// Files of a study.
inline constexpr const char* kSweepCsv = "sweep.csv";
inline constexpr const char* kSweepJson = "sweep.json";
/// Records of the finished rows, which let an interrupted study resume (SweepRecords).
inline constexpr const char* kSweepRecords = "sweep.records";

// Files of a search, in addition to those of a study.
inline constexpr const char* kFalsifyJson = "falsify.json";
/// Folder of the counterexample's run.
inline constexpr const char* kCounterexample = "counterexample";
/// Scenario in the folder of the counterexample.
inline constexpr const char* kCounterexampleYaml = "counterexample.yaml";

// Files of a verification, in addition to those of a study.
inline constexpr const char* kVerifyJson = "verify.json";

// Folder in the output folder of a study.
inline constexpr const char* kRows = "rows";  ///< Folder of the runs that a study keeps, by row.

// Files of a study that was submitted to Slurm.
inline constexpr const char* kArraySh = "array.sh";
inline constexpr const char* kMergeSh = "merge.sh";

// Files of an identification.
inline constexpr const char* kIdentifyJson = "identify.json";
/// Folder of the runs of an identification, by record.
inline constexpr const char* kRecords = "records";
/// Returns the file name <record>.residuals.csv. InputError unless the record's name is a plain
/// file name.
std::string ResidualsCsv(const std::string& record);

/// Files besides plan.json that a plan with a path may have, including the tables of all planners.
std::vector<std::string> PathFiles();

// Files of a plant, by its name in the registry: "mujoco:contact" has "mujoco-contact.csv".
// InputError for a name that would leave the folder.

std::string LogCsv(const std::string& plant);    ///< Returns <plant>.csv.
std::string StateCsv(const std::string& plant);  ///< Returns <plant>.state.csv.
// Files of the plans adopted during the run.
std::string NewPlansCsv(const std::string& plant);      ///< Returns <plant>.plan.csv.
std::string NewPlansJson(const std::string& plant);     ///< Returns <plant>.plan.json.
std::string NewPlansTreeCsv(const std::string& plant);  ///< Returns <plant>.tree.csv.

/// Returns the plant whose StateCsv has this name; nullopt for other file names. For a plant that
/// is not in the registry, returns the name as spelled in the file name.
std::optional<std::string> PlantOfStateCsv(const std::string& file_name);

/// Returns every file name that a run folder may have, for all plants in the registry.
std::vector<std::string> AllNames();

/// Checks a file of a run folder and returns its path. InputError naming the file if it does not
/// exist, is a folder, or is a link to a place outside the run folder: content from outside must
/// not enter a report. InputError if the hash of the file differs from that in the folder's
/// manifest. Run folders of older versions have no manifest, so their files are not compared with
/// hashes.
std::filesystem::path RequireFile(const std::filesystem::path& file);

/// Identifies the results in a folder by the SHA-256 of its manifest.json; "" without a manifest.
std::string ResultHash(const std::filesystem::path& folder);

/// InputError naming the folder if the replacement of its result was not finished, or if its
/// ResultHash differs from `hash`. The message names `source`, the file that states `hash`.
void RequireResult(const std::filesystem::path& folder, const std::string& hash,
                   const std::filesystem::path& source);

/// Detects whether results were replaced while their folders were read. Construct a Reading before
/// reading the files, and call RequireUnchanged afterwards.
class Reading {
 public:
  explicit Reading(std::vector<std::filesystem::path> folders);
  /// Throws InputError naming a folder whose manifest has changed.
  void RequireUnchanged() const;

 private:
  std::vector<std::filesystem::path> folders_;
  std::vector<std::string> manifests_;
};

}  // namespace trackbed::run_folder
