#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// Functions that print to the terminal, in colors and in lines that fit the terminal's width.
/// Control characters in texts from input files are replaced, so that an input file cannot control
/// the terminal.
namespace trackbed::cli {

/// Meaning of a printed text, such as good or bad, which determines the color of the text.
enum class Tone {
  kGood,      ///< Printed in green.
  kBad,       ///< Printed in red.
  kDoubtful,  ///< Printed in yellow.
  kHeading,   ///< Printed in bold.
};

/// Specifies when output is colored. With kAuto, output to a terminal is colored unless NO_COLOR is
/// non-empty (no-color.org) or TERM is "dumb".
enum class ColorChoice { kAuto, kAlways, kNever };

/// Returns the names of the color choices: "auto", "always" and "never".
const std::vector<std::string>& ColorChoices();

/// Sets the color choice for the rest of the program. Throws InternalError for a name that is not
/// in ColorChoices.
void ChooseColors(const std::string& choice);

/// Converts `text` to a single line that contains no control characters. Control characters,
/// including line feeds and tabs, are replaced by names: "<U+001B>". Bytes that are not UTF-8 are
/// replaced by names: "<0xFF>".
std::string SafeLine(std::string_view text);

/// A text that can be printed unchanged: a line without unsafe characters (SafeLine), possibly with
/// escape sequences for colors.
struct SafeText {
  std::string text;
};

/// A text of several lines. When a text of type Lines is printed, control characters are replaced
/// as in SafeLine, except line feeds and tabs.
struct Lines {
  std::string_view text;
};

/// Returns `text` as a line without control characters (SafeLine), in the color of `tone` if output
/// to `stream` is colored.
SafeText Colorize(Tone tone, std::string_view text, std::FILE* stream = stdout);

/// Replaces the control characters in a text of several lines and returns the text in the color of
/// `tone`.
SafeText Colorize(Tone tone, Lines text, std::FILE* stream);

/// Joins texts that are already safe to print, with `separator` between the texts.
SafeText Joined(const std::vector<SafeText>& parts, std::string_view separator);

}  // namespace trackbed::cli

template <>
struct fmt::formatter<trackbed::cli::SafeText> : fmt::formatter<std::string_view> {
  template <typename Context>
  auto format(const trackbed::cli::SafeText& safe, Context& context) const {
    return fmt::formatter<std::string_view>::format(safe.text, context);
  }
};

namespace trackbed::cli {

namespace detail {

inline SafeText Safe(SafeText text) {
  return text;
}

SafeText Safe(Lines text);

/// Converts an argument of fmt::format: numbers stay unchanged, and texts become safe lines
/// (SafeLine). Arguments of other types, such as the result of fmt::join, do not compile, because
/// fmt would print their texts unchanged.
template <typename T>
auto Safe(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return SafeLine(value);
  } else {
    static_assert(std::is_arithmetic_v<T>, "print a text or a number");
    return value;
  }
}

template <typename T>
using Printed = decltype(Safe(std::declval<const T&>()));

}  // namespace detail

/// Prints to `stream` like fmt::print, but converts every text to a safe line (SafeLine). All verbs
/// must print through PrintTo or Print. PrintTo throws std::system_error if the stream fails.
template <typename... T>
void PrintTo(std::FILE* stream, fmt::format_string<detail::Printed<T>...> format,
             const T&... values) {
  fmt::print(stream, format, detail::Safe(values)...);
}

/// Prints to stdout, using PrintTo.
template <typename... T>
void Print(fmt::format_string<detail::Printed<T>...> format, const T&... values) {
  fmt::print(stdout, format, detail::Safe(values)...);
}

/// Returns the width of the terminal in columns, at least 40. TerminalWidth returns 80 if `stream`
/// is not a terminal.
std::size_t TerminalWidth(std::FILE* stream = stdout);

/// Wraps `text` between words into lines of at most `width` columns. A word that is longer than a
/// line stays in one piece.
std::vector<std::string> Wrapped(std::string_view text, std::size_t width);

/// Formats a duration as "3.2 s", "4 min 5 s" or "2 h 3 min".
std::string DurationText(double seconds);

}  // namespace trackbed::cli
