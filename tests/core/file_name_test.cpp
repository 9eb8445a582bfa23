#include "trackbed/core/file_name.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

namespace trackbed {
namespace {

TEST(FileNameOf, KeepsPlainNames) {
  for (const char* name : {"prius", "BMW_320i", "a.b-c", "0", "-", "_", "three_turns.v2"}) {
    EXPECT_EQ(FileNameOf(name), name);
  }
}

TEST(FileNameOf, MakesPlainNamesOfAnyText) {
  const std::string null("a\0b", 3);
  const std::vector<std::pair<std::string, std::string>> cases{
      {"../../../victim/rel", "_._.._.._victim_rel"},
      {"/tmp/victim/abs", "_tmp_victim_abs"},
      {"a/b", "a_b"},
      {"a\\b", "a_b"},
      {"", "unnamed"},
      {".", "_"},
      {"..", "_."},
      {".hidden", "_hidden"},
      {"BMW 320i", "BMW_320i"},
      {"mujoco:contact", "mujoco-contact"},
      {"a\nb\tc\x1b[31m", "a_b_c__31m"},
      {null, "a_b"},
      {"\xff\xfe", "__"},
      {"caf\xc3\xa9", "caf__"},
      {"$(touch x)`y`;'\"|&*?", "__touch_x__y________"},
      {"~", "_"},
  };
  for (const auto& [name, file] : cases) {
    EXPECT_EQ(FileNameOf(name), file) << name;
  }
}

TEST(FileNameOf, KeepsTheEndOfALongName) {
  const std::string file = FileNameOf(std::string(5000, 'x') + "/body.stl");
  EXPECT_EQ(file.size(), kMaxFileNameLength);
  EXPECT_TRUE(file.ends_with("xx_body.stl"));
  // The cut may fall before a dot.
  EXPECT_TRUE(IsFileName(FileNameOf(std::string(5000, '.'))));
}

// FileNameOf returns one part of a path, so a file with this name stays in its folder.
TEST(FileNameOf, NeverLeavesItsFolder) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    std::string name(random() % 300, '\0');
    for (char& c : name) {
      // Half of the bytes are characters that have a meaning in paths.
      c = random() % 2 == 0 ? "./\\:~"[random() % 5] : static_cast<char>(random());
    }
    const std::string file = FileNameOf(name);
    ASSERT_TRUE(IsFileName(file)) << file;
    ASSERT_EQ(FileNameOf(file), file);
    ASSERT_EQ((std::filesystem::path("out") / file).parent_path(), "out");
  }
}

TEST(IsFileName, RefusesPathsAndHiddenNames) {
  for (const char* name : {"", ".", "..", ".x", "a/b", "/", "a b", "a\n", "caf\xc3\xa9", "a:b"}) {
    EXPECT_FALSE(IsFileName(name)) << name;
  }
  EXPECT_TRUE(IsFileName(std::string(255, 'a')));
  EXPECT_FALSE(IsFileName(std::string(256, 'a')));
}

}  // namespace
}  // namespace trackbed
