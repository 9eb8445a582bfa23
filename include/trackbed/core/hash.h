#pragma once

#include <string>
#include <string_view>

namespace trackbed {

/// SHA-256 of some bytes, hexadecimal. Cost: about 2 ns a byte.
std::string Sha256(std::string_view content);

}  // namespace trackbed
