#pragma once

#include <boost/locale/utf.hpp>

namespace trackbed {

/// Returns whether a character is invisible and affects the text around it: control characters
/// except tabs and line feeds, marks of writing direction, separators of lines and paragraphs, and
/// spaces without width. The joiners of scripts and emoji (U+200C, U+200D) do not count as
/// invisible.
bool IsInvisible(boost::locale::utf::code_point c);

}  // namespace trackbed
