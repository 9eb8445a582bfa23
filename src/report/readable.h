#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// Texts of files that anybody may have written, as a page can show them.
namespace trackbed {

/// Characters that are not seen but act on what stands around them are named: "<U+202E>". These
/// are controls except tab and line feed, Unicode's marks and overrides of writing direction
/// (annex 9), its line separators, and characters without width other than the joiners that emoji
/// and some scripts need. What is no UTF-8 becomes U+FFFD, once for each character or stray byte.
std::string Readable(const std::string& text);

/// The same of every text in `json`; names of entries are not shown, and stay.
nlohmann::ordered_json WithReadableTexts(nlohmann::ordered_json json);

}  // namespace trackbed
