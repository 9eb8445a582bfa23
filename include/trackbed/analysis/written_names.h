#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// The names of all files that the verbs write. The check for foreign files (output_folder.h), the
/// removal of results and the table of docs/cli.md all use the list of written names.
///
/// A part of a name in angle brackets is variable, as in "<plant>.csv". A name that ends in a slash
/// is the name of a folder.
namespace trackbed {

/// A kind of result: its name in manifest.json, and the names that the files of the result may
/// have.
struct ResultNames {
  std::string result;
  std::vector<std::string> names;
};

/// Returns all kinds of results that Trackbed writes.
const std::vector<ResultNames>& AllResultNames();

/// The results and files that a verb of the command line writes.
struct VerbNames {
  std::string verb;  ///< Name of the verb, such as "sweep submit".
  /// Names of the results in the verb's output folder (see AllResultNames).
  std::vector<std::string> results;
  /// Names of further files and folders in the verb's output folder: pages, videos, records and
  /// folders.
  std::vector<std::string> others{};
  /// Command-line options whose argument names a file to write. If the named file exists, the verb
  /// replaces the file.
  std::vector<std::string> explicit_files{};
};

/// Returns all verbs of the command line that write files.
const std::vector<VerbNames>& AllVerbNames();

/// Returns all names in a verb's output folder, each once, beginning with the names of the verb's
/// results.
std::vector<std::string> NamesOfVerb(std::string_view verb);

/// Maps each variable part (in angle brackets) of a file name to the texts that may replace this
/// part.
using NameParts = std::map<std::string, std::vector<std::string>>;

/// Returns the file names in the verb's output folder. Variable parts of the file names are
/// replaced by the texts in `parts` and by the names of the registered plants. The returned names
/// omit folders, and names with a variable part that `parts` does not contain.
std::vector<std::string> FileNamesOfVerb(std::string_view verb, const NameParts& parts = {});

/// Whether a file of the result may have the name `name`.
bool IsNameOf(std::string_view result, const std::string& name);

/// The text in the head of a page by which WriteReport recognizes pages that Trackbed wrote.
inline constexpr std::string_view kPageMark = "<meta name=\"generator\" content=\"Trackbed\">";
/// Returns the PNG chunk that marks a picture as written by Trackbed (W3C, Portable Network
/// Graphics, section 11.3.4: tEXt). The chunk follows the header of a .png file, and precedes the
/// end chunk of an .apng file.
const std::string& PictureMark();
/// Returns the last bytes of a video, which mark the video as written by Trackbed. The mark of a
/// video is a box that players skip (ISO/IEC 14496-12, section 8.1.2: free).
const std::string& VideoMark();
/// Returns the last chunk of an animated WebP, which marks it as written by Trackbed. Readers of
/// WebP files skip unknown chunks (RFC 9649, section 2.7.1.6).
const std::string& WebpMark();

/// Whether a page (.html), picture (.png), video (.mp4) or animation (.webp, .apng) carries the
/// mark of a file that Trackbed wrote. Returns false for links.
bool HasMark(const std::filesystem::path& file);

}  // namespace trackbed
