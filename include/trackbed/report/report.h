#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// Self-contained HTML pages of finished runs, a comparison or a study.
namespace trackbed {

/// How a page includes the videos (video.mp4) of the runs.
enum class FilmPlace {
  /// The page contains the videos, which become a third larger.
  kEmbedded,
  kBeside,  ///< The page links to the files, by relative paths.
  kAbsent,  ///< The page does not show the videos.
};

/// The data of a report page. `paths` may name
///
///   * one or more run folders, or a comparison (the folder of a compare.json), which represents
///     its run folders: the page shows metrics, verdicts, plans, logs and resolved scenarios;
///   * a study (the folder of a sweep, or its CSV file): the page shows its table;
///   * the same study before and after a change, in this order: the page shows both tables, with
///     rows of equal settings paired;
///   * a single identification: the page shows the estimates with their errors and correlations,
///     the errors against each record before and after the fit, and residuals over time.
///
/// Plants are compared at equal station, as in trackbed/analysis/compare.h. For a comparison, its
/// pairs are shown, with verdict and tolerances. For several runs, each plant of the first run is
/// compared with the plant of the same name in every other run.
///
/// Numbers are rounded to six significant digits; numbers below 5e-7 are rounded to 0. Logs with
/// more than 20000 rows in total are decimated; rows with a column's local maximum or minimum are
/// kept, so that every extreme value remains. Units are SI units and radians, as in the files.
///
/// Errors: InputError naming a missing or broken file. InputError if a path is neither a run nor a
/// comparison nor a study, or if a comparison or study is combined with other paths. InputError if
/// two studies vary different keys or have no row in common. InputError if a run is given twice, or
/// if a comparison does not match the present logs of its runs. Cost: proportional to the size of
/// the logs; a fifth of a second for a run of 60 s on two plants.
nlohmann::ordered_json ReportData(const std::vector<std::filesystem::path>& paths);

/// Makes the complete page of some data. Text from files is escaped, so that it cannot become
/// markup or script. The page's Content-Security-Policy also restricts a browser to the page's
/// scripts, by their hashes. Invisible characters are replaced by their names.
std::string ReportPage(const nlohmann::ordered_json& data);

/// Returns the page that WriteReport would write to `file`, without writing it. Throws the errors
/// of WriteReport.
std::string ReportPageOf(const std::vector<std::filesystem::path>& paths,
                         const std::filesystem::path& file, FilmPlace film);

/// Makes the report of `paths` and writes it to `file`, which is either unchanged or complete. The
/// folder of `file` is created if it is missing. The page loads nothing from a network, and forbids
/// the browser to load anything. The same folders give the same bytes. Errors: those of ReportData,
/// and RunError if a file cannot be read or written.
void WriteReport(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& file,
                 FilmPlace film = FilmPlace::kEmbedded);

}  // namespace trackbed
