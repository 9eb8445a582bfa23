#pragma once

#include <string>
#include <string_view>

namespace trackbed {

/// Explains that the content of a text file is of another kind, and how to get the text: compressed
/// data, an archive, a spreadsheet, a bag, a picture, text in UTF-16, or other binary data. Returns
/// "" for text. Needs only the begin of the content.
std::string ForeignBytes(std::string_view content);

/// As ForeignBytes; also explains empty files and web pages.
std::string ForeignContent(std::string_view content);

/// Explains why content is not of a format: ForeignContent, otherwise the error of its parser.
std::string ParseProblem(std::string_view content, std::string_view format, std::string_view error);

/// As ParseProblem for XML, in words for an error of tinyxml2 (XMLDocument::ErrorName).
std::string XmlProblem(std::string_view content, std::string_view error_name);

}  // namespace trackbed
