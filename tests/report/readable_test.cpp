#include "src/report/readable.h"

#include <gtest/gtest.h>

#include <string>

namespace trackbed {
namespace {

using nlohmann::ordered_json;

TEST(Readable, LeavesWhatCanBeSeen) {
  // Keeps markup, Hebrew, Arabic, a combining accent, emoji joined by U+200D and with a variation
  // selector, and the non-joiner U+200C of Persian.
  for (const char* text :
       {"", "a corner, <b>\"'&\n\tmarked", "\xD7\xA9\xD7\x9C\xD7\x95\xD7\x9D", "\xD8\xB3",
        "e\xCC\x81", "\xF0\x9F\x91\xA9\xE2\x80\x8D\xF0\x9F\x9A\x80", "\xE2\x9D\xA4\xEF\xB8\x8F",
        "\xD9\x85\xE2\x80\x8C\xD8\xAE", "\xEF\xBF\xBD"}) {
    EXPECT_EQ(Readable(text), text);
  }
}

TEST(Readable, NamesWhatActsUnseen) {
  EXPECT_EQ(Readable("invoice\xE2\x80\xAE"
                     "fdp.exe"),
            "invoice<U+202E>fdp.exe");
  EXPECT_EQ(Readable("\xE2\x81\xA6"
                     "a\xE2\x81\xA9\xE2\x80\x8F\xD8\x9C"),
            "<U+2066>a<U+2069><U+200F><U+061C>");
  EXPECT_EQ(Readable(std::string("a\0b", 3)), "a<U+0000>b");
  EXPECT_EQ(Readable("\x1B[31m\r\x7F\xC2\x85"), "<U+001B>[31m<U+000D><U+007F><U+0085>");
  EXPECT_EQ(Readable("x\xE2\x80\x8By\xEF\xBB\xBF\xE2\x80\xA8\xF3\xA0\x81\x81"),
            "x<U+200B>y<U+FEFF><U+2028><U+E0041>");
}

TEST(Readable, PutsOneSignForEachBrokenCharacter) {
  const std::string sign = "\xEF\xBF\xBD";
  // An invalid start byte, a truncated character, an overlong encoding of two bytes, half of a
  // UTF-16 surrogate pair, and a code point beyond Unicode.
  EXPECT_EQ(Readable("\xFF"
                     "a"),
            sign + "a");
  EXPECT_EQ(Readable("a\xE2\x82"), "a" + sign);
  EXPECT_EQ(Readable("\xC0\xAF/"), sign + "/");
  EXPECT_EQ(Readable("\xED\xA0\x80."), sign + ".");
  EXPECT_EQ(Readable("\xF4\x90\x80\x80."), sign + ".");
}

TEST(WithReadableTexts, ReachesEveryText) {
  const ordered_json json{
      {"a", "\x01"}, {"b", {1.5, "\x02", {{"c", "\x03"}}}}, {"d", nullptr}, {"e", true}};
  EXPECT_EQ(WithReadableTexts(json).dump(),
            R"({"a":"<U+0001>","b":[1.5,"<U+0002>",{"c":"<U+0003>"}],"d":null,"e":true})");
}

}  // namespace
}  // namespace trackbed
