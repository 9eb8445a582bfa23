#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// The names of all files that the verbs write. The check for foreign files (output_folder.h), the
/// removal of results and the table of docs/cli.md all use this list.
///
/// A part in angle brackets is variable: "<plant>.csv". A name that ends in a slash is a folder.
namespace trackbed {

/// The name of a result in manifest.json, with the names that its files may have.
struct ResultNames {
  std::string result;
  std::vector<std::string> names;
};

/// All results that Trackbed writes.
const std::vector<ResultNames>& AllResultNames();

/// The results and files that a verb writes.
struct VerbNames {
  std::string verb;                  ///< Name of the verb, such as "sweep submit".
  std::vector<std::string> results;  ///< Results in the verb's output folder, see AllResultNames.
  /// Further names in the verb's output folder: pages and films, records, folders.
  std::vector<std::string> others{};
  /// Options whose argument names a file to write. An existing file is replaced.
  std::vector<std::string> explicit_files{};
};

/// All verbs that write files.
const std::vector<VerbNames>& AllVerbNames();

/// All names in a verb's output folder, each once. The names of the verb's results come first.
std::vector<std::string> NamesOfVerb(std::string_view verb);

/// For each part in angle brackets, the texts that may replace it in a file name.
using NameParts = std::map<std::string, std::vector<std::string>>;

/// Returns the file names in the verb's output folder, with `parts` and the registered plants
/// inserted. Omits folders, and names with parts in angle brackets that `parts` does not contain.
std::vector<std::string> FileNamesOfVerb(std::string_view verb, const NameParts& parts = {});

/// Whether a file of the result may have this name.
bool IsNameOf(std::string_view result, const std::string& name);

/// The text in the head of a page by which WriteReport recognizes Trackbed's pages.
inline constexpr std::string_view kPageMark = "<meta name=\"generator\" content=\"Trackbed\">";
/// The PNG chunk that marks a picture as Trackbed's; the chunk follows the header (W3C, Portable
/// Network Graphics, section 11.3.4: tEXt).
const std::string& PictureMark();
/// The last bytes of a video, which mark it as Trackbed's: a box that players skip (ISO/IEC
/// 14496-12, section 8.1.2: free).
const std::string& VideoMark();

/// Whether the file carries Trackbed's mark: a page (.html), picture (.png) or video (.mp4).
/// Returns false for links.
bool HasMark(const std::filesystem::path& file);

}  // namespace trackbed
