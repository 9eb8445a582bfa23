#pragma once

#include <string>
#include <string_view>

/// Converts names in the input, such as the name of a model, log or plant, to file names. The
/// resulting file names contain no folder separators.
namespace trackbed {

/// Maximum length of a file name from FileNameOf [bytes]. File systems allow 255 bytes per name.
/// The bytes beyond kMaxFileNameLength are reserved for file extensions and for the longer names of
/// temporary files.
inline constexpr std::size_t kMaxFileNameLength = 100;

/// Converts `name` to a plain file name. Keeps letters, digits, '.', '_' and '-', replaces ':' by
/// '-', and replaces every other byte by '_'. Replaces a leading dot by '_', so that the file name
/// is never that of a hidden file, "." or "..". Shortens a name of more than kMaxFileNameLength
/// bytes to its last kMaxFileNameLength bytes, which include the extension. Returns "unnamed" for
/// an empty name. Different names may be converted to the same file name.
std::string FileNameOf(std::string_view name);

/// Whether `name` is a plain file name: 1 to 255 letters, digits, '.', '_' and '-', not beginning
/// with a dot.
bool IsFileName(std::string_view name);

}  // namespace trackbed
