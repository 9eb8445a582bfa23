#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/sim/compile_scene.h"
#include "trackbed/sim/scene.h"

/// Tests models from untrusted sources: which files they may reference, and inputs that crash
/// MuJoCo's readers.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

std::string Bytes(auto number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// A binary STL file that claims `claimed` triangles and has one.
std::string Stl(std::uint32_t claimed) {
  std::string stl(80, ' ');
  stl += Bytes(claimed);
  for (const float number : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
    stl += Bytes(number);
  }
  return stl + Bytes(std::uint16_t{0});
}

/// The header of a PNG picture of this size.
std::string Png(unsigned width, unsigned height) {
  std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  for (const unsigned number : {width, height}) {
    for (const unsigned shift : {24U, 16U, 8U, 0U}) {
      png += static_cast<char>(number >> shift & 0xffU);
    }
  }
  return png;
}

std::string Model(const std::string& assets, const std::string& world = "") {
  return fmt::format("<mujoco>\n<asset>{}</asset>\n<worldbody>{}</worldbody></mujoco>", assets,
                     world);
}

/// The error message without the folder; "" if composing succeeds.
std::string Refusal(const TempFolder& folder, const std::string& model,
                    const std::vector<fs::path>& allowed = {}) {
  const fs::path file = folder.Write("own/car.xml", model);
  try {
    ComposeScene(file, {.asset_folders = allowed});
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string path = folder.path().string() + "/";
    for (std::size_t at = message.find(path); at != std::string::npos; at = message.find(path)) {
      message.erase(at, path.size());
    }
    return message;
  }
  return "";
}

TEST(ModelFiles, LieInTheModelsFolder) {
  const TempFolder folder;
  folder.Write("own/deep/er/part.xml", "<mujoco><compiler/></mujoco>");
  folder.Write("own/part.xml", "<mujoco><compiler/></mujoco>");
  folder.Write("own/body.stl", Stl(1));
  folder.Write("own2/body.stl", Stl(1));
  folder.Write("body.stl", Stl(1));
  EXPECT_EQ(Refusal(folder, "<mujoco><include file='deep/er/part.xml'/></mujoco>"), "");
  EXPECT_EQ(Refusal(folder, "<mujoco><include file='deep/../part.xml'/></mujoco>"), "");
  EXPECT_EQ(Refusal(folder, Model("<mesh file='body.stl'/>")), "");
  const std::string outside =
      "which lies outside of the folder of the file that names it; --allow-assets DIR allows a "
      "folder whose files may be read";
  EXPECT_EQ(Refusal(folder, "<mujoco>\n<include file='../part.xml'/></mujoco>"),
            "own/car.xml:2: <include> refers to own/../part.xml, " + outside);
  EXPECT_EQ(Refusal(folder, Model("<mesh file='../body.stl'/>")),
            "own/car.xml:2: <mesh> refers to own/../body.stl, " + outside);
  // Checks a folder that shares only a name prefix, and a folder that <compiler> names.
  EXPECT_THAT(Refusal(folder, Model("<mesh file='../own2/body.stl'/>")), EndsWith(outside));
  EXPECT_THAT(Refusal(folder,
                      "<mujoco><compiler meshdir='..'/><asset><mesh file='body.stl'/>"
                      "</asset></mujoco>"),
              EndsWith(outside));
  EXPECT_THAT(Refusal(folder, Model("<texture type='skybox' fileup='../body.png'/>")),
              EndsWith(outside));
  // Absolute names are rejected even for permitted files.
  const std::string own = (folder.path() / "own/body.stl").string();
  EXPECT_THAT(
      Refusal(folder, Model("<mesh file='" + own + "'/>")),
      HasSubstr("which is an absolute path, not one below the folder of the file that names it; "
                "--allow-assets DIR"));
  EXPECT_THAT(Refusal(folder, Model("<mesh file='/etc/hostname'/>")),
              HasSubstr("refers to /etc/hostname, which is an absolute path"));
  EXPECT_THAT(Refusal(folder,
                      "<mujoco><compiler texturedir='/etc'/><asset><texture "
                      "file='hostname'/></asset></mujoco>"),
              HasSubstr("refers to /etc/hostname, which is an absolute path"));
}

TEST(ModelFiles, AreNotReadThroughLinks) {
  const TempFolder folder;
  folder.Write("other/body.stl", Stl(1));
  folder.Write("own/real.stl", Stl(1));
  fs::create_symlink(folder.path() / "other/body.stl", folder.path() / "own/link.stl");
  fs::create_symlink(folder.path() / "other", folder.path() / "own/folder");
  fs::create_symlink("real.stl", folder.path() / "own/near.stl");
  EXPECT_THAT(Refusal(folder, Model("<mesh file='link.stl'/>")),
              HasSubstr("lies outside of the folder"));
  EXPECT_THAT(Refusal(folder, Model("<mesh file='folder/body.stl'/>")),
              HasSubstr("lies outside of the folder"));
  EXPECT_EQ(Refusal(folder, Model("<mesh file='near.stl'/>")), "");
}

TEST(ModelFiles, MayLieInFoldersThatTheUserAllows) {
  const TempFolder folder;
  folder.Write("other/deep/body.stl", Stl(1));
  fs::create_symlink(folder.path() / "other/deep/body.stl", folder.path() / "own.stl");
  const std::string relative = Model("<mesh file='../other/deep/body.stl'/>");
  EXPECT_NE(Refusal(folder, relative), "");
  EXPECT_EQ(Refusal(folder, relative, {folder.path() / "other"}), "");
  EXPECT_EQ(Refusal(folder, relative, {folder.path() / "none", folder.path() / "other/"}), "");
  EXPECT_NE(Refusal(folder, relative, {folder.path() / "other/dee"}), "");
  const std::string absolute = (folder.path() / "other/deep/body.stl").string();
  EXPECT_EQ(Refusal(folder, Model("<mesh file='" + absolute + "'/>"), {folder.path() / "other"}),
            "");
}

TEST(ModelFiles, HaveTheSizesThatTheirHeadersTell) {
  const TempFolder folder;
  const auto refusal = [&](const std::string& kind, const std::string& name,
                           const std::string& content) {
    folder.Write("own/" + name, content);
    const std::string message = Refusal(folder, Model("<" + kind + " file='" + name + "'/>"));
    const std::string before =
        fmt::format("own/car.xml:2: <{}> refers to own/{}, which ", kind, name);
    EXPECT_TRUE(message.empty() || message.starts_with(before)) << message;
    return message.substr(std::min(message.size(), before.size()));
  };
  const std::string no_stl = "is no binary STL file of 1 to 200000 triangles";
  EXPECT_EQ(refusal("mesh", "a.stl", Stl(1)), "");
  EXPECT_EQ(refusal("mesh", "a.STL", Stl(2)), no_stl);
  EXPECT_EQ(refusal("mesh", "a.stl", Stl(0)), no_stl);
  EXPECT_EQ(refusal("mesh", "a.stl", Stl(0xffffffffU)), no_stl);
  EXPECT_EQ(refusal("mesh", "a.stl", "solid"), no_stl);
  EXPECT_EQ(refusal("mesh", "a.stl", ""), "is empty");
  EXPECT_EQ(refusal("mesh", "a.msh", Stl(1)), "must be a .obj or binary .stl file");
  EXPECT_EQ(refusal("skin", "a.skn", Stl(1)), "is not read: files of <skin> are not supported");
  EXPECT_EQ(refusal("texture", "a.png", Png(8192, 1)), "");
  EXPECT_EQ(refusal("texture", "a.png", Png(40000, 40000)),
            "has 40000 x 40000 pixels; must have at most 8192 on a side");
  EXPECT_EQ(refusal("texture", "a.png", Png(0, 1)), "is a PNG picture without a size");
  EXPECT_EQ(refusal("texture", "a.png", Png(1, 1).substr(0, 20)),
            "is a PNG picture without a size");
  EXPECT_EQ(refusal("texture", "a.png", "\x89PNG"), "is no PNG picture");
  EXPECT_EQ(refusal("texture", "a.bin", Png(1, 1)), "must be a .png file");
  const auto heights = [](std::int32_t rows, std::int32_t columns, float height) {
    return Bytes(rows) + Bytes(columns) + Bytes(1.F) + Bytes(0.F) + Bytes(0.F) + Bytes(height);
  };
  EXPECT_EQ(refusal("hfield", "a.hfield", heights(2, 2, 0.F)), "");
  EXPECT_EQ(refusal("hfield", "a.hfield", heights(2, 3, 0.F)),
            "has 24 bytes; 2 x 3 heights take 32");
  const std::string no_field = "is no height field of 2 to 4096 rows and columns";
  EXPECT_EQ(refusal("hfield", "a.hfield", heights(-1, 2, 0.F)), no_field);
  EXPECT_EQ(refusal("hfield", "a.hfield", heights(65536, 65536, 0.F)), no_field);
  EXPECT_EQ(refusal("hfield", "a.hfield", "abc"), no_field);
  EXPECT_EQ(refusal("hfield", "a.hfield", heights(2, 2, std::numeric_limits<float>::quiet_NaN())),
            "has a height that is not finite, in row 2");
}

TEST(ModelFiles, AreNotReadBeyondAnySize) {
  const TempFolder folder;
  const fs::path large = folder.Write("own/large.obj", "v 0 0 0\n");
  fs::resize_file(large, std::uintmax_t{1} << 36U);  // 64 GB, sparse
  EXPECT_EQ(Refusal(folder, Model("<mesh file='large.obj'/>")),
            "own/car.xml:2: <mesh> refers to own/large.obj, which has more than 64 MB");
  std::string many;
  folder.Write("own/a.stl", Stl(1));
  for (int i = 0; i < 1950; ++i) {
    many += fmt::format("<mesh name='m{}' file='a.stl'/>", i);
  }
  EXPECT_THAT(Refusal(folder, Model(many)), EndsWith("more than 1900 files of assets"));
  folder.Write("own/b.obj", "v 0 0 0\n#" + std::string(std::size_t{60} << 20U, '.'));
  std::string large_together;
  for (int i = 0; i < 9; ++i) {
    large_together += fmt::format("<mesh name='m{}' file='b.obj'/>", i);
  }
  EXPECT_THAT(Refusal(folder, Model(large_together)),
              EndsWith("the files of assets are larger than 512 MB together"));
}

// MuJoCo also accepts <Include> as <include>.
TEST(ModelFiles, AreIncludedInOneSpellingAlone) {
  const TempFolder folder;
  folder.Write("other.xml", "<mujoco/>");
  for (const char* name : {"Include", "INCLUDE"}) {
    EXPECT_EQ(Refusal(folder, fmt::format("<mujoco>\n<{} file='../other.xml'/></mujoco>", name)),
              fmt::format("own/car.xml:2: <{}> must be written <include>", name));
  }
}

TEST(ModelFiles, HavePlainNamesInRunFolders) {
  const TempFolder folder;
  folder.Write("own/a b\\c\"\n.stl", Stl(1));
  const fs::path file = folder.Write("own/car.xml", Model("<mesh file='a b\\c&quot;&#10;.stl'/>"));
  const Scene scene = ComposeScene(file, {});
  ASSERT_EQ(scene.assets.size(), 1U);
  EXPECT_EQ(scene.assets[0].name, "asset0_a_b_c__.stl");
}

TEST(ModelElements, HaveBounds) {
  const TempFolder folder;
  const std::string name(600, 'a');
  EXPECT_EQ(Refusal(folder, Model("<mesh file='" + name + "'/>")),
            "own/car.xml:2: <mesh>: a word of file has 600 characters; must have at most 200");
  EXPECT_EQ(Refusal(folder, Model("", "<geom class='" + name + "'/>")),
            "own/car.xml:3: <geom>: a word of class has 600 characters; must have at most 200");
  std::string numbers;
  for (int i = 0; i < 1000; ++i) {
    numbers += "0.125 ";
  }
  EXPECT_EQ(Refusal(folder, Model("<mesh name='m' vertex='" + numbers + "'/>")), "");
  EXPECT_EQ(Refusal(folder, Model("<texture builtin='flat' width='40000' height='9'/>")),
            "own/car.xml:2: <texture>: width is 40000; must be from 0 to 8192");
  EXPECT_EQ(Refusal(folder, Model("<texture builtin='flat' width='9' height='-1'/>")),
            "own/car.xml:2: <texture>: height is -1; must be from 0 to 8192");
  EXPECT_EQ(Refusal(folder, Model("<hfield name='h' nrow='1000000' ncol='1000000'/>")),
            "own/car.xml:2: <hfield>: nrow is 1000000; must be from 0 to 4096");
  EXPECT_EQ(Refusal(folder, "<mujoco>\n<visual><quality numslices='100000'/></visual></mujoco>"),
            "own/car.xml:2: <quality>: numslices is 100000; must be from 0 to 256");
}

std::string CompileError(const std::string& xml, const std::vector<SceneAsset>& assets = {}) {
  return ErrorText(
      [&] { CompileScene(Scene{.xml = xml, .assets = assets}, "car.xml", Looks::kKept); });
}

TEST(CompileScene, OutlivesCrashesOfMujocosReaders) {
  // MuJoCo 2.2.2 follows face indices beyond the vertices, in files and in the model's text. Newer
  // versions check them.
  const std::string failed = "car.xml: does not compile: MuJoCo's compiler failed: ";
  EXPECT_THAT(CompileError(Model("<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1' "
                                 "face='0 1 2000000000 0 1 -2000000000'/>",
                                 "<geom type='mesh' mesh='m'/>")),
              AnyOf(StartsWith(failed), EndsWith("vertex index 2000000000 does not exist ('m')")));
  EXPECT_THAT(CompileError(Model("<mesh name='m' file='a.obj'/>", "<geom type='mesh' mesh='m'/>"),
                           {{"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2000000000\n"}}),
              AnyOf(StartsWith(failed), EndsWith("at least 4 vertices required ('m')")));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(CompileScene, HasBoundsOfMemory) {
  // Newer versions of MuJoCo abort when an allocation fails.
  EXPECT_THAT(CompileError("<mujoco><size nuser_body='2000000000'/></mujoco>"),
              AnyOf("car.xml: does not compile: takes more than 2048 MB of memory",
                    "car.xml: does not compile: MuJoCo's compiler failed: Aborted"));
  EXPECT_EQ(CompileError("<mujoco><size njmax='2000000000' nconmax='2000000000'/></mujoco>"),
            "car.xml: does not compile: takes more than 2048 MB of memory");
}
#endif

TEST(CompileScene, OpensNoFile) {
  const TempFolder folder;
  const std::string tetrahedron =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string geom = "<geom type='mesh' mesh='m'/>";
  EXPECT_EQ(CompileError(Model("<mesh name='m' file='a.obj'/>", geom), {{"a.obj", tetrahedron}}),
            "");
  const fs::path file = folder.Write("body.obj", tetrahedron);
  EXPECT_THAT(CompileError(Model("<mesh name='m' file='" + file.string() + "'/>", geom)),
              StartsWith("car.xml: does not compile: "));
}

std::string SavedBytes(const mjModel& model) {
  std::string bytes(static_cast<std::size_t>(mj_sizeModel(&model)), '\0');
  mj_saveModel(&model, nullptr, bytes.data(), static_cast<int>(bytes.size()));
  return bytes;
}

TEST(CompileScene, GivesTheSameModelFromBothProcesses) {
  for (const std::string& name : ModelNames()) {
    Scene scene = ComposeScene(FindModel(name, ""), {});
    EXPECT_TRUE(scene.trusted) << name;
    const MujocoModel here = CompileScene(scene, name, Looks::kKept);
    scene.trusted = false;
    const MujocoModel apart = CompileScene(scene, name, Looks::kKept);
    EXPECT_TRUE(SavedBytes(*here) == SavedBytes(*apart)) << name;
  }
}

// Trust is by content: only files equal to the shipped models are trusted, in any folder.
TEST(CompileScene, TrustsFilesThatComeWithTrackbedAlone) {
  const TempFolder folder;
  const std::string prius = ReadFile(FindModel("prius", ""));
  EXPECT_TRUE(ComposeScene(folder.Write("copy.xml", prius), {}).trusted);
  EXPECT_FALSE(ComposeScene(folder.Write("changed.xml", prius + " "), {}).trusted);
  folder.Write("part.xml", "<mujoco/>");
  const std::string car = "<mujoco><include file='part.xml'/></mujoco>";
  EXPECT_FALSE(ComposeScene(folder.Write("car.xml", car), {}).trusted);
}

}  // namespace
}  // namespace trackbed
