#include "src/report/readable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/locale/utf.hpp>

namespace trackbed {
namespace {

using boost::locale::utf::code_point;
using nlohmann::ordered_json;

struct CodePointRange {
  code_point first;
  code_point last;
};

constexpr std::array kInvisibleRanges{
    CodePointRange{0x00, 0x08},      CodePointRange{0x0B, 0x1F},     CodePointRange{0x7F, 0x9F},
    CodePointRange{0xAD, 0xAD},      CodePointRange{0x061C, 0x061C}, CodePointRange{0x180E, 0x180E},
    CodePointRange{0x200B, 0x200B},  CodePointRange{0x200E, 0x200F}, CodePointRange{0x2028, 0x202E},
    CodePointRange{0x2060, 0x206F},  CodePointRange{0xFEFF, 0xFEFF}, CodePointRange{0xFFF9, 0xFFFB},
    CodePointRange{0xE0000, 0xE007F}};

bool IsInvisible(code_point c) {
  return std::any_of(
      kInvisibleRanges.begin(), kInvisibleRanges.end(),
      [c](const CodePointRange& range) { return range.first <= c && c <= range.last; });
}

bool IsPlain(char c) {
  return (c >= ' ' && c <= '~') || c == '\n' || c == '\t';
}

bool Continues(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

void MakeReadable(ordered_json& json) {
  if (json.is_string()) {
    json = Readable(json.get_ref<const std::string&>());
  } else if (json.is_structured()) {
    std::for_each(json.begin(), json.end(), MakeReadable);
  }
}

}  // namespace

std::string Readable(const std::string& text) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  if (std::all_of(text.begin(), text.end(), IsPlain)) {
    return text;  // fast path for plain text, because most long texts are embedded videos
  }
  std::string readable;
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = at;
    const code_point c = Utf8::decode(at, text.end());
    if (c == boost::locale::utf::illegal || c == boost::locale::utf::incomplete) {
      // Skips the remaining bytes of an invalid UTF-8 character.
      at = std::find_if_not(begin + 1, text.end(), Continues);
      readable += "\xEF\xBF\xBD";
    } else if (IsInvisible(c)) {
      readable += fmt::format("<U+{:04X}>", c);
    } else {
      readable.append(begin, at);
    }
  }
  return readable;
}

ordered_json WithReadableTexts(ordered_json json) {
  MakeReadable(json);
  return json;
}

}  // namespace trackbed
