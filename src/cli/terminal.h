#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// Prints to the terminal, in colors and in lines that fit the terminal's width. Control characters
/// in texts from input files are replaced, so that an input file cannot control the terminal.
namespace trackbed::cli {

/// Meaning of a text, which determines its color.
enum class Tone {
  kGood,      ///< green
  kBad,       ///< red
  kDoubtful,  ///< yellow
  kHeading,   ///< bold
};

/// Specifies when output is colored. With kAuto, output to a terminal is colored unless NO_COLOR is
/// set and not empty (no-color.org) or TERM is "dumb".
enum class ColorChoice { kAuto, kAlways, kNever };

/// Returns the names of the color choices: "auto", "always" and "never".
const std::vector<std::string>& ColorChoices();

/// Sets the color choice for the rest of the program. Throws InternalError for a name that is not
/// in ColorChoices.
void ChooseColors(const std::string& choice);

/// Converts `text` to one safe line. Control characters, including line feeds and tabs, are
/// replaced by names: "<U+001B>". Bytes that are not UTF-8 are replaced by names: "<0xFF>".
std::string SafeLine(std::string_view text);

/// A text that can be printed unchanged: a safe line (SafeLine), possibly with escape sequences for
/// colors.
struct SafeText {
  std::string text;
};

/// A text of several lines. A text of type Lines is made safe like a SafeLine, but keeps its line
/// feeds and tabs.
struct Lines {
  std::string_view text;
};

/// Returns `text` as a safe line, in the color of the tone if output to `stream` is colored.
SafeText Colorize(Tone tone, std::string_view text, std::FILE* stream = stdout);

/// Makes a text of several lines safe and colors it.
SafeText Colorize(Tone tone, Lines text, std::FILE* stream);

/// Joins safe texts, with `separator` between the texts.
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

/// Converts an argument for fmt: passes numbers unchanged and makes texts safe. Texts of other
/// types do not compile, because fmt::join would print these texts unchanged.
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

/// Prints to `stream` like fmt::print, but converts every text to a safe line (SafeLine). Verbs
/// print only through PrintTo and Print. PrintTo throws std::system_error if the stream fails.
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

/// Returns the width of the terminal in columns, at least 40. Returns 80 if `stream` is not a
/// terminal.
std::size_t TerminalWidth(std::FILE* stream = stdout);

/// Wraps `text` between words into lines of at most `width` columns. A word longer than a line is
/// not broken.
std::vector<std::string> Wrapped(std::string_view text, std::size_t width);

/// Formats a duration as "3.2 s", "4 min 5 s" or "2 h 3 min".
std::string DurationText(double seconds);

}  // namespace trackbed::cli
