#include "trackbed/core/file_name.h"

#include <algorithm>

namespace trackbed {
namespace {

/// Returns whether a file name may contain the character, independent of the locale.
bool IsPlain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '.' ||
         c == '_' || c == '-';
}

}  // namespace

std::string FileNameOf(std::string_view name) {
  if (name.empty()) {
    return "unnamed";
  }
  std::string file(name.substr(name.size() - std::min(name.size(), kMaxFileNameLength)));
  for (char& c : file) {
    c = IsPlain(c) ? c : c == ':' ? '-' : '_';
  }
  if (file.front() == '.') {
    file.front() = '_';
  }
  return file;
}

bool IsFileName(std::string_view name) {
  constexpr std::size_t kMaxNameLength = 255;  // longest file name on Linux (NAME_MAX)
  return !name.empty() && name.size() <= kMaxNameLength && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), IsPlain);
}

}  // namespace trackbed
