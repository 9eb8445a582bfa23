#pragma once

#include <string>
#include <string_view>

namespace trackbed {

/// Explains the kind of content that is not plain text, and how to get plain text from such
/// content. Recognizes compressed data, archives, spreadsheets, bags, pictures, text in UTF-16, and
/// other binary data. Returns "" for plain text. The first bytes of a file suffice as `content`.
std::string ForeignBytes(std::string_view content);

/// Same as ForeignBytes, but also explains empty files and web pages.
std::string ForeignContent(std::string_view content);

/// Explains why the content of a file does not have the expected format. Returns the text of
/// ForeignContent; if this text is empty, returns the parser's error.
std::string ParseProblem(std::string_view content, std::string_view format, std::string_view error);

/// Same as ParseProblem, but for content that should be XML. States the error of tinyxml2
/// (XMLDocument::ErrorName) in words.
std::string XmlProblem(std::string_view content, std::string_view error_name);

}  // namespace trackbed
