#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// Makes self-contained HTML pages on finished runs, a comparison, a study or an identification.
namespace trackbed {

/// How a page includes the videos (video.mp4) of the runs.
enum class FilmPlace {
  /// The page contains the videos, whose encoding as base64 makes them a third larger.
  kEmbedded,
  kBeside,  ///< The page links to the video files, by relative paths.
  kAbsent,  ///< The page does not show the videos.
};

/// Returns the data of a report page as JSON. `paths` may be
///
///   * one or more run folders, or a comparison (the folder of a compare.json), whose run folders
///     are used: the page shows metrics, verdicts, plans, logs and resolved scenarios;
///   * a study (the folder of a sweep, or the CSV file of a study): the page shows the table of the
///     study;
///   * two runs of a study, first the one before a change, then the one after it: the page shows
///     both tables, and pairs the rows with equal settings;
///   * a single identification: the page shows the estimates with their standard errors and
///     correlations, the prediction errors for each record before and after the fit, and the
///     residuals over time.
///
/// Plants are compared at equal station, as in trackbed/analysis/compare.h. The page of a
/// comparison shows the compared pairs of plants, with verdict and tolerances. If `paths` are
/// several runs, each plant of the first run is compared with the plant of the same name in every
/// other run.
///
/// Numbers are rounded to six significant digits; magnitudes below 5e-7 are rounded to 0. Logs with
/// more than 7500 rows in total are thinned. Thinning keeps rows in which a column has a local
/// maximum or minimum, so extreme values remain. Quantities are in SI units and radians, as in the
/// files.
///
/// Errors: InputError naming a missing or broken file. InputError if a path is neither a run, a
/// comparison, a study nor an identification, or if one of the latter three is combined with other
/// paths. InputError if two studies vary different keys or have no row in common. InputError if a
/// run is given twice, or if a comparison does not match the present logs of its runs. The cost is
/// proportional to the size of the logs: a fifth of a second for a run of 60 s on two plants.
nlohmann::ordered_json ReportData(const std::vector<std::filesystem::path>& paths);

/// Makes the complete HTML page from the data of a report. Text from files is escaped, so that it
/// cannot become markup or script. In addition, the page's Content-Security-Policy lets a browser
/// run only the page's own scripts, identified by their hashes. Invisible characters are replaced
/// by their names.
std::string ReportPage(const nlohmann::ordered_json& data);

/// Returns the page that WriteReport would write to `file`, but writes nothing. Throws the errors
/// of WriteReport.
std::string ReportPageOf(const std::vector<std::filesystem::path>& paths,
                         const std::filesystem::path& file, FilmPlace film);

/// Makes the report of `paths` and writes it to `file`. After an error, `file` is unchanged. The
/// folder of `file` is created if it is missing. The page loads nothing from a network, and forbids
/// the browser to load anything. The same folders always give the same bytes. Errors: those of
/// ReportData, and RunError if a file cannot be read or written.
void WriteReport(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& file,
                 FilmPlace film = FilmPlace::kEmbedded);

}  // namespace trackbed
