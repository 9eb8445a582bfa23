#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The names of the files in the folders of runs, comparisons and studies. The page docs/cli.md
/// describes the content of the files in these folders.
namespace trackbed::run_folder {

// Manifest of the results in a folder, with the size and SHA-256 hash of each file.
inline constexpr const char* kManifest = "manifest.json";
// Names of hidden folders that exist in the output folder while a result is written (see
// output_folder.h).
/// Hidden folder of a result that is not complete yet.
inline constexpr const char* kPartial = ".trackbed.partial";
/// Hidden folder of a complete result that is being moved into place.
inline constexpr const char* kComplete = ".trackbed.complete";
// Names of the kinds of results, as written in manifest.json.
inline constexpr const char* kRun = "run";
inline constexpr const char* kPlan = "plan";
inline constexpr const char* kComparison = "comparison";
inline constexpr const char* kStudy = "study";
inline constexpr const char* kIdentification = "identification";
inline constexpr const char* kFalsification = "falsification";
inline constexpr const char* kVerification = "verification";
inline constexpr const char* kSubmission = "submission";

// Names of the files that a run writes.
inline constexpr const char* kScenarioYaml = "scenario.resolved.yaml";
inline constexpr const char* kModelXml = "model.xml";
inline constexpr const char* kPlanCsv = "plan.csv";
inline constexpr const char* kPlanJson = "plan.json";
inline constexpr const char* kScheduleCsv = "schedule.csv";
inline constexpr const char* kTreeCsv = "tree.csv";
inline constexpr const char* kTimingJson = "timing.json";
inline constexpr const char* kMetricsJson = "metrics.json";
inline constexpr const char* kMcap = "run.mcap";

// Names of the files that are made from a finished run.
inline constexpr const char* kVideo = "video.mp4";
inline constexpr const char* kPicture = "picture.png";
inline constexpr const char* kReport = "report.html";  ///< Report of a run, comparison or study.

// Names of the files that a comparison writes. A comparison of the plants of one run is written to
// the folder of that run.
inline constexpr const char* kCompareCsv = "compare.csv";
inline constexpr const char* kCompareJson = "compare.json";

// Names of the files that a study writes.
inline constexpr const char* kSweepCsv = "sweep.csv";
inline constexpr const char* kSweepJson = "sweep.json";
/// File with the records of the finished rows, from which an interrupted study can resume
/// (SweepRecords).
inline constexpr const char* kSweepRecords = "sweep.records";

// Names of the files that a search for counterexamples writes, in addition to the files of a study.
inline constexpr const char* kFalsifyJson = "falsify.json";
/// Folder with the run of the counterexample.
inline constexpr const char* kCounterexample = "counterexample";
/// Scenario file in the folder of the counterexample.
inline constexpr const char* kCounterexampleYaml = "counterexample.yaml";

// Names of the files that a verification writes, in addition to the files of a study.
inline constexpr const char* kVerifyJson = "verify.json";

// Name of a folder in the output folder of a study.
inline constexpr const char* kRows = "rows";  ///< Folder with a run folder for each kept row.

// Names of the files of a study that was submitted to Slurm.
inline constexpr const char* kArraySh = "array.sh";
inline constexpr const char* kMergeSh = "merge.sh";

// Names of the files that an identification writes.
inline constexpr const char* kIdentifyJson = "identify.json";
/// Folder with one run folder for each record of an identification.
inline constexpr const char* kRecords = "records";
/// Returns the name of the file with the residuals of a record, <record>.residuals.csv. Throws
/// InputError unless the record's name is a plain file name.
std::string ResidualsCsv(const std::string& record);

/// Returns the names of the files, besides plan.json, that a plan with a path may have, including
/// the tables of all planners.
std::vector<std::string> PathFiles();

// The functions below return file names for a plant, given by its name in the registry. For
// example, the log of "mujoco:contact" is "mujoco-contact.csv". The functions that return names of
// a plant's files throw InputError if the plant's name would lead to a file outside of the run
// folder.

std::string LogCsv(const std::string& plant);    ///< Returns the name <plant>.csv (log).
std::string StateCsv(const std::string& plant);  ///< Returns the name <plant>.state.csv.
// Names of the files with the plans that were adopted during the run.
/// Returns the file name <plant>.plan.csv (paths of the plans).
std::string NewPlansCsv(const std::string& plant);
/// Returns the file name <plant>.plan.json (details of the plans).
std::string NewPlansJson(const std::string& plant);
/// Returns the file name <plant>.tree.csv (search trees).
std::string NewPlansTreeCsv(const std::string& plant);

/// Returns the plant for which StateCsv returns `file_name`; nullopt if `file_name` is not the name
/// of a state log. If the plant is not in the registry, its name is returned as spelled in the file
/// name.
std::optional<std::string> PlantOfStateCsv(const std::string& file_name);

/// Returns every file name that a run folder may have, for all plants in the registry.
std::vector<std::string> AllNames();

/// Checks that a file of a run folder may be read, and returns the file's path. Throws InputError,
/// naming the file, if the file does not exist, is a folder, or is a link to a place outside the
/// run folder. Links to places outside the run folder are rejected because content from outside
/// must not enter a report. Throws InputError if the hash of the file differs from the hash in the
/// folder's manifest. In a run folder without a manifest, written by an old version of Trackbed,
/// the hashes of files are not checked.
std::filesystem::path RequireFile(const std::filesystem::path& file);

/// Returns the SHA-256 hash of the folder's manifest.json, which identifies the results in the
/// folder; "" if the folder has no manifest.
std::string ResultHash(const std::filesystem::path& folder);

/// Throws InputError, naming the folder, if the replacement of the folder's result was not
/// finished, or if ResultHash(folder) differs from `hash`. The error message also names `source`,
/// the file in which `hash` is stated.
void RequireResult(const std::filesystem::path& folder, const std::string& hash,
                   const std::filesystem::path& source);

/// Detects whether another process replaced results while this process read their folders.
/// Construct a Reading before reading files of a run folder, and call RequireUnchanged after
/// reading them.
class Reading {
 public:
  explicit Reading(std::vector<std::filesystem::path> folders);
  /// Throws InputError, naming the folder, if the manifest of a folder has changed.
  void RequireUnchanged() const;

 private:
  std::vector<std::filesystem::path> folders_;
  std::vector<std::string> manifests_;
};

}  // namespace trackbed::run_folder
