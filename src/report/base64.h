#pragma once

#include <string>

namespace trackbed {

/// Encodes bytes as padded base64 (RFC 4648).
std::string Base64(const std::string& bytes);

}  // namespace trackbed
