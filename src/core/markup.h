#pragma once

#include <string>
#include <string_view>

namespace trackbed {

/// If a text is XML or HTML instead of a table, returns a message that explains how to convert it;
/// otherwise "". MarkupProblem reads only the beginning of the text, up to the first element.
std::string MarkupProblem(std::string_view text);

/// Returns whether a text is a web page, that is, whether its first element is html.
bool IsWebPage(std::string_view text);

}  // namespace trackbed
