#include "src/fmu/unit/calls.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>

namespace trackbed::fmu {

std::filesystem::path PathOfUri(const std::string& uri) {
  // RFC 8089 permits three forms of file URIs: file:/path, file:///path and file://localhost/path.
  std::string rest;
  for (const char* start : {"file://localhost/", "file:///", "file:/"}) {
    if (uri.starts_with(start)) {
      rest = uri.substr(std::strlen(start) - 1);
      break;
    }
  }
  if (rest.empty()) {
    throw InputError(Problem{
        .message = fmt::format("the resource location is '{}'; must begin with file:///", uri)});
  }
  std::string path;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    unsigned char byte = 0;
    const char* const digits = rest.data() + i + 1;
    if (rest[i] == '%' && i + 2 < rest.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      path += static_cast<char>(byte);
      i += 2;
    } else {
      path += rest[i];
    }
  }
  return path;
}

void CopyTo(const std::string& bytes, void* target, std::size_t size) {
  if (size < bytes.size()) {
    throw InputError(Problem{
        .message = fmt::format("the serialized state has {} bytes, but there is room for {}",
                               bytes.size(), size)});
  }
  std::memcpy(target, bytes.data(), bytes.size());
}

}  // namespace trackbed::fmu
