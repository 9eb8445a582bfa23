#pragma once

#include <string>
#include <string_view>

namespace trackbed {

/// Explains that a text is XML or HTML instead of a table, and how to convert it; "" for other
/// texts. Reads only the beginning of the text, up to the first element.
std::string MarkupProblem(std::string_view text);

/// Whether a text is a web page: its first element is html.
bool IsWebPage(std::string_view text);

}  // namespace trackbed
