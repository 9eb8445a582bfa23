#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// Makes text from untrusted files safe to show on a page.
namespace trackbed {

/// Replaces invisible characters that affect the text around them by their names: "<U+202E>". These
/// are controls except tab and line feed, Unicode's marks and overrides of writing direction (annex
/// 9), its line separators, and zero-width characters except the joiners that emoji and some
/// scripts need. Invalid UTF-8 becomes U+FFFD, once per character or stray byte.
std::string Readable(const std::string& text);

/// Applies Readable to all texts in `json`. Names of entries are not shown and stay unchanged.
nlohmann::ordered_json WithReadableTexts(nlohmann::ordered_json json);

}  // namespace trackbed
