#include "trackbed/core/error.h"

#include <boost/locale/utf.hpp>
#include <filesystem>

#include "trackbed/core/invisible.h"

namespace trackbed {
namespace {

std::string Join(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) {
      text += '\n';
    }
    text += problem.ToString();
  }
  return text;
}

/// Shortens a text for an error message, because an input file may contain, for example, a word of
/// a million letters.
std::string Cut(const std::string& text) {
  constexpr std::size_t kMaxMessageLength = 4000;
  if (text.size() <= kMaxMessageLength) {
    return text;
  }
  std::size_t end = kMaxMessageLength;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
    --end;  // do not cut the text inside a multibyte UTF-8 character
  }
  return text.substr(0, end) + " ...";
}

/// Replaces the line feeds in a text, so that a name with line feeds cannot imitate a separate
/// error message.
std::string OneLine(const std::string& text) {
  std::string line;
  for (const char c : WithoutControls(text)) {
    line += c == '\n' ? "<U+000A>" : std::string(1, c);
  }
  return line;
}

}  // namespace

std::string Problem::WithoutPlace() const {
  return OneLine(key.empty() ? Cut(message) : Cut(key) + ": " + Cut(message));
}

std::string Problem::ToString() const {
  std::string place = file;
  if (line > 0) {
    place += ':' + std::to_string(line);
  }
  if (line > 0 && column > 0) {
    place += ':' + std::to_string(column);
  }
  if (!place.empty()) {
    place += ": ";
  }
  return OneLine(place) + WithoutPlace();
}

std::string WithoutControls(std::string_view text) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  std::string shown;
  const char* const end = text.data() + text.size();
  const char* at = text.data();
  while (at != end) {
    const char* const begin = at;
    const boost::locale::utf::code_point c = Utf8::decode(at, end);
    if (c == boost::locale::utf::illegal || c == boost::locale::utf::incomplete) {
      at = begin + 1;
      shown += fmt::format("<0x{:02X}>", static_cast<unsigned char>(*begin));
    } else if (IsInvisible(c)) {
      shown += fmt::format("<U+{:04X}>", c);
    } else {
      shown.append(begin, at);
    }
  }
  return shown;
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(Join(problems)), problems_(std::move(problems)) {}

void ThrowPreconditionError(const std::string& message) {
  throw PreconditionError(message);
}

void ThrowInternalError(const char* file, int line, const char* condition,
                        const std::string& message) {
  throw InternalError(fmt::format("{}:{}: {} ({} does not hold)",
                                  std::filesystem::path(file).filename().string(), line, message,
                                  condition));
}

}  // namespace trackbed
