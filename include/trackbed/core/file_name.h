#pragma once

#include <string>
#include <string_view>

/// File names made from names in the input. The name of a model, a log or a plant never becomes a
/// path.
namespace trackbed {

/// The longest result of FileNameOf [bytes]. File systems allow 255 bytes, which leaves room for
/// file extensions and for the marks of temporary files.
inline constexpr std::size_t kMaxFileNameLength = 100;

/// Converts `name` to a plain file name. Letters, digits, '.', '_' and '-' stay, ':' becomes '-',
/// and every other byte becomes '_'. A leading dot becomes '_', so that the result is never a
/// hidden file, "." or "..". A longer name is shortened to its last kMaxFileNameLength bytes, which
/// include the extension. An empty name becomes "unnamed". Several names may give the same file
/// name.
std::string FileNameOf(std::string_view name);

/// Whether `name` is a plain file name: 1 to 255 letters, digits, '.', '_' and '-', not beginning
/// with a dot.
bool IsFileName(std::string_view name);

}  // namespace trackbed
