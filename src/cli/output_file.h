#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace trackbed::cli {

/// Returns the output folder of a command: the value of its option `--out`, or `below` in `parent`
/// if the option is empty. The path `below` comes from a name in an untrusted input, so
/// OutputFolderOf throws RunError if a part of `below` is a link or a file (FolderBelow). The
/// folder given by `--out` and the folder `parent` may be links.
std::filesystem::path OutputFolderOf(const std::string& option, const std::filesystem::path& below,
                                     const std::filesystem::path& parent = "out");

/// Returns whether an existing file was written by Trackbed for the same option and may be
/// replaced.
using WroteFile = std::function<bool(const std::filesystem::path&)>;

/// Recognizes a file by its first bytes, such as the names of a table's columns.
WroteFile BeginsWith(std::string text);
/// Recognizes a web page by a text in its first 4096 bytes.
WroteFile HasInHead(std::string text);
/// Recognizes a file by its last bytes.
WroteFile EndsWith(std::string text);
/// Returns whether a file is a model that ends with ModelMark and was not edited after Trackbed
/// wrote it.
bool IsUneditedModel(const std::filesystem::path& file);

/// Returns a comment to append to the text of a model that Trackbed writes. The comment contains
/// the hash of the text.
std::string ModelMark(std::string_view xml);

/// Prepares to write the file that an option names. Call PrepareOutputFile before the computation
/// of the file's contents. Creates the folder of the file and checks that the file can be written
/// (PrepareToWrite). PrepareOutputFile throws InputError if the output file is one of the files
/// `inputs`, even under another name, or belongs to a result (ResultThatLists). PrepareOutputFile
/// also throws InputError if `wrote` does not recognize the contents of the file. Inputs that do
/// not exist, such as names of models, are ignored.
void PrepareOutputFile(const char* option, const std::filesystem::path& file,
                       const std::vector<std::filesystem::path>& inputs, const WroteFile& wrote);

}  // namespace trackbed::cli
