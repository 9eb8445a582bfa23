#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace trackbed::cli {

/// Returns the output folder of a command: the value of its option `--out`, or `below` in `parent`
/// if the option is empty. The path `below` comes from a name in an untrusted input. OutputFolderOf
/// therefore throws RunError if a part of `below` is a link or a file (FolderBelow). The folder of
/// the option and `parent` may be links.
std::filesystem::path OutputFolderOf(const std::string& option, const std::filesystem::path& below,
                                     const std::filesystem::path& parent = "out");

/// Returns whether an existing file was written by the option that would replace it.
using WroteFile = std::function<bool(const std::filesystem::path&)>;

/// Recognizes a file by its first bytes, such as the names of a table's columns.
WroteFile BeginsWith(std::string text);
/// Recognizes a page by a text among its first 4096 bytes.
WroteFile HasInHead(std::string text);
/// Recognizes a file by its last bytes.
WroteFile EndsWith(std::string text);
/// Returns whether a file is a model that ends with ModelMark and was not edited after Trackbed
/// wrote it.
bool IsUneditedModel(const std::filesystem::path& file);

/// Returns a comment to append to the text of a model that Trackbed writes. The comment contains
/// the hash of the text.
std::string ModelMark(std::string_view xml);

/// Prepares to write the file that an option names; call this function before the work that
/// computes the contents. Creates the folder of the file and checks that the file can be written
/// (PrepareToWrite). An existing file will be replaced, so PrepareOutputFile throws InputError if
/// the file is one of `inputs`, under this or another name, or a file of a result
/// (ResultThatLists). PrepareOutputFile also throws InputError if `wrote` does not recognize the
/// contents of the file. Inputs that do not exist, such as names of models, are ignored.
void PrepareOutputFile(const char* option, const std::filesystem::path& file,
                       const std::vector<std::filesystem::path>& inputs, const WroteFile& wrote);

}  // namespace trackbed::cli
