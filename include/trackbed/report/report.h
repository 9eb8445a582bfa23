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
  kBeside,    ///< the page refers to the files where they lie, relative to itself
  kAbsent,    ///< the page does not show them
};

/// What the page shows, as it stands in it: metrics, verdicts, plans, logs and resolved scenarios
/// of one or more run folders, or of those that one comparison (the folder of a compare.json) is
/// of; or the table of one study (the folder of a sweep, or its CSV file), also compared with that
/// of the same study before a change, which is given first: rows that set the same, in pairs.
///
/// Plants are compared at equal station as in trackbed/analysis/compare.h: those that a comparison
/// has judged, with its verdict and tolerances, and each plant of the first of several runs with
/// its namesake in every other.
///
/// Of an identification, given alone: the estimates with their errors and correlations, the errors
/// against each record before and after the fit, and residuals over time.
///
/// Numbers are rounded to six significant digits, those below 5e-7 to 0. Logs with more than 20000
/// rows in total are decimated; rows with a column's local maximum or minimum are kept, so that
/// every extreme value stays. SI units and radians, as in the files.
///
/// Errors: InputError naming what is missing or broken, when a path is neither a run nor a
/// comparison nor a study, when one of the latter is mixed with something else, when two studies
/// vary different keys or have no row in common, when a run is given twice, and when a comparison
/// is not of the logs that its runs have now. Cost: proportional to the size of the logs; 60 s on
/// two plants take a fifth of a second.
nlohmann::ordered_json ReportData(const std::vector<std::filesystem::path>& paths);

/// The whole page of some data. Text from files never becomes markup or script, whatever is in it:
/// it is escaped, and the page's Content-Security-Policy lets a browser run nothing but the page's
/// own scripts, which it knows by their hashes. Characters that cannot be seen are named.
std::string ReportPage(const nlohmann::ordered_json& data);

/// The page that WriteReport writes to `file`, which is not touched. Errors: those of WriteReport.
std::string ReportPageOf(const std::vector<std::filesystem::path>& paths,
                         const std::filesystem::path& file, FilmPlace film);

/// Makes the report of `paths` and writes it to `file`, which is either what it was or complete;
/// its folder is made if it is missing. The page loads nothing from a network and forbids the
/// browser to. The same folders give the same bytes. Errors: as ReportData, and RunError when
/// something cannot be read or written.
void WriteReport(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& file,
                 FilmPlace film = FilmPlace::kEmbedded);

}  // namespace trackbed
