#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The names of the files in the folders of runs, comparisons and studies. docs/cli.md describes
/// the files.
namespace trackbed::run_folder {

// Of every result: the sizes and SHA-256 of its files.
inline constexpr const char* kManifest = "manifest.json";
// Hidden folders in the output folder while a result is written: see output_folder.h.
inline constexpr const char* kPartial = ".trackbed.partial";  ///< not complete yet
inline constexpr const char* kComplete =
    ".trackbed.complete";  ///< complete, being moved into place
// The names of the results in the manifest.
inline constexpr const char* kRun = "run";
inline constexpr const char* kPlan = "plan";
inline constexpr const char* kComparison = "comparison";
inline constexpr const char* kStudy = "study";
inline constexpr const char* kIdentification = "identification";
inline constexpr const char* kFalsification = "falsification";
inline constexpr const char* kVerification = "verification";
inline constexpr const char* kSubmission = "submission";

// Of a run.
inline constexpr const char* kScenarioYaml = "scenario.resolved.yaml";
inline constexpr const char* kModelXml = "model.xml";
inline constexpr const char* kPlanCsv = "plan.csv";
inline constexpr const char* kPlanJson = "plan.json";
inline constexpr const char* kScheduleCsv = "schedule.csv";
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
/// Grows with the study and lets an interrupted study resume: SweepRecords.
inline constexpr const char* kSweepRecords = "sweep.records";

// Of a search, in addition to those of a study.
inline constexpr const char* kFalsifyJson = "falsify.json";
inline constexpr const char* kCounterexample = "counterexample";  ///< the folder of its run
inline constexpr const char* kCounterexampleYaml = "counterexample.yaml";  ///< in that folder

// Of a verification, beside those of a study.
inline constexpr const char* kVerifyJson = "verify.json";

// Of a study, in whose folder they are.
inline constexpr const char* kRows = "rows";  ///< the folder of the runs that it keeps, by row

// Of a study that was handed to Slurm.
inline constexpr const char* kArraySh = "array.sh";
inline constexpr const char* kMergeSh = "merge.sh";

// Of an identification.
inline constexpr const char* kIdentifyJson = "identify.json";
inline constexpr const char* kRecords = "records";  ///< the folder of its runs, by record
/// <record>.residuals.csv. InputError unless the record's name is a plain file name.
std::string ResidualsCsv(const std::string& record);

/// Files that a plan with a path may have beside plan.json, with the tables of all planners.
std::vector<std::string> PathFiles();

// Files of a plant, by its name in the registry: "mujoco:contact" has "mujoco-contact.csv".
// InputError for a name that would leave the folder.

std::string LogCsv(const std::string& plant);    ///< <plant>.csv
std::string StateCsv(const std::string& plant);  ///< <plant>.state.csv
// Of the plans adopted during the run.
std::string NewPlansCsv(const std::string& plant);      ///< <plant>.plan.csv
std::string NewPlansJson(const std::string& plant);     ///< <plant>.plan.json
std::string NewPlansTreeCsv(const std::string& plant);  ///< <plant>.tree.csv

/// The plant whose StateCsv has this name; nullopt for the name of another file. For a plant that
/// is not in the registry, returns the name as spelled in the file name.
std::optional<std::string> PlantOfStateCsv(const std::string& file_name);

/// Every file name that a run folder may have, for all plants in the registry.
std::vector<std::string> AllNames();

/// Returns `file`, which must be a file of a run folder. InputError naming it if it does not exist,
/// is a folder, or is a link out of the run folder, whose content must not enter a report. If the
/// folder has a manifest (folders of older versions do not), also InputError unless the file's
/// content matches it; this reads the file.
std::filesystem::path RequireFile(const std::filesystem::path& file);

/// Tells the results in a folder from others: the SHA-256 of its manifest.json, "" if it has none.
std::string ResultHash(const std::filesystem::path& folder);

/// InputError naming the folder if it is between two results, or if it has results with another
/// ResultHash than `hash`, which is that in the file `source`.
void RequireResult(const std::filesystem::path& folder, const std::string& hash,
                   const std::filesystem::path& source);

/// Detects whether results were replaced while their folders were read. Construct it before reading
/// the files and call RequireUnchanged afterwards, so that no folder's files mix two results.
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
