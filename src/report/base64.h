#pragma once

#include <string>

namespace trackbed {

/// Encodes bytes as base64 text with padding (RFC 4648).
std::string Base64(const std::string& bytes);

}  // namespace trackbed
