#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// Makes text from untrusted files safe to show on a page.
namespace trackbed {

/// Replaces invisible characters that affect the text around them by names such as "<U+202E>". The
/// replaced characters are control characters other than tab and line feed, Unicode's marks and
/// overrides of the writing direction (annex 9), Unicode's line separators, and zero-width
/// characters. Zero-width joiners are kept, because emoji and some scripts need them. Each invalid
/// UTF-8 sequence is replaced by U+FFFD.
std::string Readable(const std::string& text);

/// Replaces invisible characters (Readable) in all text values in `json`. JSON keys stay unchanged,
/// because the page does not show them.
nlohmann::ordered_json WithReadableTexts(nlohmann::ordered_json json);

}  // namespace trackbed
