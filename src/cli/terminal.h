#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

/// What terminals can do that files and pipes cannot: colors, and a width to keep to.
namespace trackbed::cli {

/// What a text means to its reader.
enum class Tone {
  kGood,      ///< green
  kBad,       ///< red
  kDoubtful,  ///< yellow
  kHeading,   ///< bold
};

/// When to print colors; kAuto: on a terminal, unless NO_COLOR is set and not empty
/// (no-color.org) or TERM is "dumb".
enum class ColorChoice { kAuto, kAlways, kNever };

/// "auto", "always" and "never".
const std::vector<std::string>& ColorChoices();

/// For the rest of the program. InternalError unless it is one of ColorChoices.
void ChooseColors(const std::string& choice);

/// `text` in the tone's color, if `stream` is to have colors.
std::string Toned(Tone tone, std::string_view text, std::FILE* stream = stdout);

/// Columns of the terminal: 80 where there is none, at least 40.
std::size_t TerminalWidth(std::FILE* stream = stdout);

/// `text` broken between words into lines of at most `width` columns. Words that are longer stay
/// whole.
std::vector<std::string> Wrapped(std::string_view text, std::size_t width);

/// "3.2 s", "4 min 5 s", "2 h 3 min".
std::string DurationText(double seconds);

}  // namespace trackbed::cli
