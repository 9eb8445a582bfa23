#pragma once

#include <string>

namespace trackbed {

/// Bytes as padded base64 (RFC 4648).
std::string Base64(const std::string& bytes);

}  // namespace trackbed
