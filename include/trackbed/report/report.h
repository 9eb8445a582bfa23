#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// Makes self-contained HTML pages that show finished runs, a comparison, a study or an
/// identification.
namespace trackbed {

/// How a report page includes the videos (video.mp4) of the runs.
enum class FilmPlace {
  /// The page contains the videos, encoded as base64, which makes the videos a third larger.
  kEmbedded,
  kBeside,  ///< The page links to the video files with relative paths.
  kAbsent,  ///< The page neither contains nor links to the videos.
};

/// Returns the data of a report page as JSON. The argument `paths` names runs, a study, two results
/// of a study, or an identification.
///
/// To show runs, `paths` contains one or more run folders, or a comparison (the folder of a
/// compare.json), whose run folders are used. The page of runs shows metrics, verdicts, plans, logs
/// and resolved scenarios. To show a study, `paths` contains the folder of a sweep or the CSV file
/// of a study. The page of a study shows the study's table. To compare two results of the same
/// study, `paths` contains first the result before a change, then the result after the change. The
/// page of two study results shows both tables, and pairs rows with equal settings. The page of a
/// single identification shows the estimates with their standard errors and correlations, the
/// prediction errors for each record before and after the fit, and the residuals over time.
///
/// Plants are compared with each other at equal stations, as described in
/// trackbed/analysis/compare.h. The page of a comparison shows the compared pairs of plants, with
/// verdict and tolerances. If `paths` contains several runs, each plant of the first run is
/// compared with the plant of the same name in every other run.
///
/// Numbers are rounded to six significant digits; magnitudes below 5e-7 are rounded to 0. If the
/// logs have more than 7500 rows in total, rows are left out (thinning). Thinning of the logs keeps
/// the rows in which a column has a local maximum or minimum, so that no extreme value is lost.
/// Quantities are in SI units and radians, as in the run folders.
///
/// Throws InputError if a file is missing or invalid. Throws InputError if a path is neither a run,
/// a comparison, a study nor an identification, or if a comparison, study or identification is
/// combined with other paths. Throws InputError if two studies vary different keys or have no row
/// in common. Throws InputError if the same run is given twice, or if the logs of the runs have
/// changed since the comparison was made. The computing time is proportional to the size of the
/// logs: a fifth of a second for a run of 60 s on two plants.
nlohmann::ordered_json ReportData(const std::vector<std::filesystem::path>& paths);

/// Makes the complete HTML page from the data of a report. Text from files is escaped, so that the
/// text cannot act as markup or script. The page's Content-Security-Policy lets a browser run only
/// the page's own scripts, identified by their hashes. Invisible characters in texts are replaced
/// by the names of the characters.
std::string ReportPage(const nlohmann::ordered_json& data);

/// Returns the page that WriteReport would write to `file`, without writing a file. Throws the same
/// errors as WriteReport.
std::string ReportPageOf(const std::vector<std::filesystem::path>& paths,
                         const std::filesystem::path& file, FilmPlace film);

/// Makes the report of `paths` and writes it to `file`. If WriteReport throws an exception, `file`
/// is unchanged. Creates the folder of `file` if the folder is missing. The report page loads
/// nothing from a network, and forbids the browser to load anything. The same run folders always
/// result in the same page, byte for byte. Throws the same errors as ReportData. Throws RunError if
/// a file cannot be read or written.
void WriteReport(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& file,
                 FilmPlace film = FilmPlace::kEmbedded);

/// Returns the report page of a run in progress; the page grows during the run. The argument `data`
/// is the ReportData of a run folder in which the log of each plant has only one row. The page of a
/// run in progress has neither metrics nor a verdict. The live page connects to the WebSocket
/// `live` of its server. The live page has the same Content-Security-Policy as every report, but
/// also allows the connection to the WebSocket. The `id` identifies the run: if the server
/// announces a different id, the browser reloads the page.
std::string LivePage(const nlohmann::ordered_json& data, const std::string& id);

}  // namespace trackbed
