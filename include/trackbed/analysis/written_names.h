#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// The names of all files that the verbs write: the one list from which the check for files of
/// others (output_folder.h), the removal of results and the table of docs/cli.md follow.
///
/// A part in angle brackets stands for what differs: "<plant>.csv". A name that ends in a slash is
/// a folder.
namespace trackbed {

/// A result as manifest.json calls it, with the names that its files may have.
struct ResultNames {
  std::string result;
  std::vector<std::string> names;
};

/// Every result there is.
const std::vector<ResultNames>& AllResultNames();

/// What a verb writes.
struct VerbNames {
  std::string verb;                  ///< as in "sweep submit"
  std::vector<std::string> results;  ///< of its output folder, see AllResultNames
  /// Beside them in that folder: pages and films, records, folders.
  std::vector<std::string> others{};
  /// Options whose argument names a file to write: it replaces what is there.
  std::vector<std::string> explicit_files{};
};

/// Every verb that writes.
const std::vector<VerbNames>& AllVerbNames();

/// All names of a verb's output folder, those of its results first, each once.
std::vector<std::string> NamesOfVerb(std::string_view verb);

/// Texts for the parts in angle brackets.
using NameParts = std::map<std::string, std::vector<std::string>>;

/// The names that files of the verb's output folder have with these parts, and with the plants of
/// the registry; without those of folders, and those with other parts.
std::vector<std::string> FileNamesOfVerb(std::string_view verb, const NameParts& parts = {});

/// Whether a file of the result may have this name.
bool IsNameOf(std::string_view result, const std::string& name);

/// The text that a page carries in its head: with it WriteReport tells its pages from others.
inline constexpr std::string_view kPageMark = "<meta name=\"generator\" content=\"Trackbed\">";
/// The chunk behind the header of a picture (W3C, Portable Network Graphics, section 11.3.4: tEXt).
const std::string& PictureMark();
/// The last bytes of a video: a box that players skip (ISO/IEC 14496-12, section 8.1.2: free).
const std::string& VideoMark();

/// Whether the file is a page (.html), picture (.png) or video (.mp4) that carries Trackbed's mark,
/// and no link.
bool HasMark(const std::filesystem::path& file);

}  // namespace trackbed
