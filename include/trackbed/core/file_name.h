#pragma once

#include <string>
#include <string_view>

/// File names made of names from input. A name of a model, a log or a plant never becomes a path.
namespace trackbed {

/// The longest result of FileNameOf [bytes]. Endings and the marks of temporary files fit behind
/// it: file systems allow 255.
inline constexpr std::size_t kMaxFileNameLength = 100;

/// `name` as a plain file name: letters, digits, '.', '_' and '-' stay, ':' becomes '-', and every
/// other byte '_'. A leading dot becomes '_' as well, so that no name is hidden, "." or "..". Of a
/// longer name the last kMaxFileNameLength bytes stay: they tell the format. An empty name becomes
/// "unnamed". Several names may become one.
std::string FileNameOf(std::string_view name);

/// Whether `name` is a plain file name: 1 to 255 letters, digits, '.', '_' and '-', the first of
/// which is no dot.
bool IsFileName(std::string_view name);

}  // namespace trackbed
