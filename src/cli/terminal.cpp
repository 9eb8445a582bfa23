#include "src/cli/terminal.h"

#include <fmt/color.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "trackbed/core/error.h"

namespace trackbed::cli {
namespace {

ColorChoice color_choice = ColorChoice::kAuto;

bool ShowsColors(std::FILE* stream) {
  if (color_choice != ColorChoice::kAuto) {
    return color_choice == ColorChoice::kAlways;
  }
  const char* refused = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return (refused == nullptr || *refused == '\0') &&
         (terminal == nullptr || std::string_view(terminal) != "dumb") &&
         ::isatty(::fileno(stream)) != 0;
}

}  // namespace

const std::vector<std::string>& ColorChoices() {
  static const std::vector<std::string> names{"auto", "always", "never"};
  return names;
}

void ChooseColors(const std::string& choice) {
  const auto at = std::find(ColorChoices().begin(), ColorChoices().end(), choice);
  TRACKBED_CHECK(at != ColorChoices().end(), "color choice {}", choice);
  color_choice = static_cast<ColorChoice>(at - ColorChoices().begin());
}

std::string SafeLine(std::string_view text) {
  std::string line;
  for (const char c : WithoutControls(text)) {
    line += c == '\n' ? "<U+000A>" : c == '\t' ? "<U+0009>" : std::string(1, c);
  }
  return line;
}

namespace {

SafeText Colored(Tone tone, std::string safe, std::FILE* stream) {
  if (!ShowsColors(stream)) {
    return {std::move(safe)};
  }
  const fmt::text_style style = tone == Tone::kGood       ? fmt::fg(fmt::terminal_color::green)
                                : tone == Tone::kBad      ? fmt::fg(fmt::terminal_color::red)
                                : tone == Tone::kDoubtful ? fmt::fg(fmt::terminal_color::yellow)
                                                          : fmt::text_style(fmt::emphasis::bold);
  return {fmt::format(style, "{}", safe)};
}

}  // namespace

SafeText Colorize(Tone tone, std::string_view text, std::FILE* stream) {
  return Colored(tone, SafeLine(text), stream);
}

SafeText Colorize(Tone tone, Lines text, std::FILE* stream) {
  return Colored(tone, WithoutControls(text.text), stream);
}

SafeText Joined(const std::vector<SafeText>& parts, std::string_view separator) {
  SafeText all;
  for (const SafeText& part : parts) {
    all.text.append(&part == &parts.front() ? "" : separator).append(part.text);
  }
  return all;
}

namespace detail {

SafeText Safe(Lines text) {
  return {WithoutControls(text.text)};
}

}  // namespace detail

std::size_t TerminalWidth(std::FILE* stream) {
  winsize size{};
  const bool known = ::ioctl(::fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? std::max<std::size_t>(size.ws_col, 40) : 80;
}

std::vector<std::string> Wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines(1);
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) {
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

std::string DurationText(double seconds) {
  if (seconds < 59.95) {
    return fmt::format("{:.1f} s", seconds);
  }
  const auto whole = static_cast<long long>(std::llround(seconds));
  return whole < 3600 ? fmt::format("{} min {} s", whole / 60, whole % 60)
                      : fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace trackbed::cli
