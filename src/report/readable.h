#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// Makes text from untrusted files safe to show on a page.
namespace trackbed {

/// Replaces invisible characters that affect the text around them by names such as "<U+202E>".
/// Control characters other than tab and line feed are replaced. Readable also replaces Unicode's
/// marks and overrides of writing direction (annex 9), Unicode's line separators, and zero-width
/// characters. Zero-width joiners, which emoji and some scripts need, are kept. Invalid UTF-8
/// becomes U+FFFD, once per character or stray byte.
std::string Readable(const std::string& text);

/// Applies Readable to all texts in `json`. Names of entries in `json` are not shown and stay
/// unchanged.
nlohmann::ordered_json WithReadableTexts(nlohmann::ordered_json json);

}  // namespace trackbed
