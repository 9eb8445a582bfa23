#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// A self-contained HTML page of finished runs, a comparison or a study.
namespace trackbed {

/// How the videos (video.mp4) of the runs are included.
enum class FilmPlace {
  kEmbedded,  ///< in the page, a third larger than the files
  kBeside,    ///< the page links to the files, by relative paths
  kAbsent,    ///< the page does not show them
};

/// The contents of a report page, by what `paths` name:
///   * one or more run folders, or a comparison (the folder of a compare.json), which stands for
///     its run folders: metrics, verdicts, plans, logs and resolved scenarios;
///   * a study (the folder of a sweep, or its CSV file): its table;
///   * the same study before and after a change, in this order: both tables, with rows of equal
///     settings paired;
///   * an identification, given alone: the estimates with their errors and correlations, the errors
///     against each record before and after the fit, and residuals over time.
///
/// Plants are compared at equal station as in trackbed/analysis/compare.h: the pairs of a
/// comparison, with its verdict and tolerances; and each plant of the first of several runs with
/// the plant of the same name in every other run.
///
/// Numbers are rounded to six significant digits, those below 5e-7 to 0. Logs with more than 20000
/// rows in total are decimated; rows with a column's local maximum or minimum are kept, so that
/// every extreme value remains. SI units and radians, as in the files.
///
/// Errors: InputError naming what is missing or broken; when a path is neither a run nor a
/// comparison nor a study; when a comparison or study is mixed with something else; when two
/// studies vary different keys or have no row in common; when a run is given twice; and when a
/// comparison does not match the present logs of its runs. Cost: proportional to the size of the
/// logs; 60 s on two plants take a fifth of a second.
nlohmann::ordered_json ReportData(const std::vector<std::filesystem::path>& paths);

/// The complete page of some data. Text from files is escaped, so that it cannot become markup or
/// script; the page's Content-Security-Policy also restricts a browser to the page's scripts, by
/// their hashes. Invisible characters are replaced by their names.
std::string ReportPage(const nlohmann::ordered_json& data);

/// The page that WriteReport would write to `file`; writes nothing. Errors: those of WriteReport.
std::string ReportPageOf(const std::vector<std::filesystem::path>& paths,
                         const std::filesystem::path& file, FilmPlace film);

/// Makes the report of `paths` and writes it to `file`, which is either unchanged or complete; its
/// folder is made if it is missing. The page loads nothing from a network, and forbids the browser
/// to. The same folders give the same bytes. Errors: as ReportData, and RunError when a file cannot
/// be read or written.
void WriteReport(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& file,
                 FilmPlace film = FilmPlace::kEmbedded);

}  // namespace trackbed
