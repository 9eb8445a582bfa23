#include "src/report/readable.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/utf.hpp>

#include "trackbed/core/invisible.h"

namespace trackbed {
namespace {

using boost::locale::utf::code_point;
using nlohmann::ordered_json;

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
    return text;  // fast path for text that needs no replacement, because most long texts are
                  // embedded videos
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
