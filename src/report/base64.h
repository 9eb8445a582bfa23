#pragma once

#include <string>

namespace trackbed {

/// Bytes as base64 with padding (RFC 4648).
std::string Base64(const std::string& bytes);

}  // namespace trackbed
