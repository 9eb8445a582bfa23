#include "trackbed/sim/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string MessageOf(const std::filesystem::path& file) {
  try {
    ComposeScene(file, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FindModel, KnowsNamesAndPaths) {
  const std::filesystem::path prius = FindModel("prius", "");
  EXPECT_TRUE(std::filesystem::is_regular_file(prius));
  EXPECT_EQ(FindModel("./prius.xml", prius.parent_path()), prius.parent_path() / "./prius.xml");
  EXPECT_EQ(FindModel(prius.string(), "/somewhere"), prius);
  EXPECT_THAT(ModelNames(), testing::Contains("prius"));
}

TEST(FindModel, SuggestsTheNearestName) {
  try {
    FindModel("pruis", "");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "unknown model 'pruis'; did you mean 'prius'?");
  }
}

TEST(ComposeScene, SetsTheTimestepLast) {
  const TempFolder folder;
  const auto file = folder.Write("car.xml", "<mujoco><option timestep='0.1'/></mujoco>");
  const Scene scene = ComposeScene(file, {.timestep = 0.004});
  EXPECT_LT(scene.xml.find("timestep=\"0.1\""), scene.xml.find("timestep=\"0.004\""));
}

TEST(ComposeScene, PutsIncludedFilesInPlace) {
  const TempFolder folder;
  const auto file =
      folder.Write("car.xml", "<mujoco><include file='parts/one.xml'/><worldbody/></mujoco>");
  folder.Write("parts/one.xml",
               "<mujoco><size njmax='7'/><include file='parts/two.xml'/></mujoco>");
  folder.Write("parts/two.xml", "<mujoco><size nconmax='9'/></mujoco>");
  const std::string xml = ComposeScene(file, {}).xml;
  EXPECT_THAT(xml, Not(HasSubstr("include")));
  EXPECT_LT(xml.find("njmax"), xml.find("nconmax"));
  EXPECT_LT(xml.find("nconmax"), xml.find("worldbody"));
}

TEST(ComposeScene, TakesAssetsAlong) {
  const TempFolder folder;
  const auto file = folder.Write("car.xml",
                                 "<mujoco><compiler meshdir='shapes'/><asset>"
                                 "<mesh file='body.stl'/></asset></mujoco>");
  folder.Write("shapes/body.stl", "solid");
  const Scene scene = ComposeScene(file, {});
  ASSERT_EQ(scene.assets.size(), 1U);
  EXPECT_EQ(scene.assets[0].name, "asset0_body.stl");
  EXPECT_EQ(scene.assets[0].content, "solid");
  EXPECT_THAT(scene.xml, HasSubstr("file=\"asset0_body.stl\""));
  EXPECT_THAT(scene.xml, HasSubstr("name=\"body\""));  // what MuJoCo would have called it
  EXPECT_THAT(scene.xml, Not(HasSubstr("meshdir")));

  WriteScene(scene, folder.path() / "model.xml");
  EXPECT_EQ(ReadFile(folder.path() / "model.xml"), scene.xml);
  EXPECT_EQ(ReadFile(folder.path() / "asset0_body.stl"), "solid");
}

TEST(ComposeScene, NamesFileAndLineOfWhatIsWrong) {
  const TempFolder folder;
  const std::string at = folder.path().string();
  EXPECT_EQ(MessageOf(folder.path() / "none.xml"), at + "/none.xml: no such file");
  EXPECT_EQ(MessageOf(folder.Write("a.xml", "<mujoco>\n<body>\n</mujoco>")),
            at + "/a.xml:2:1: not well-formed XML: XML_ERROR_MISMATCHED_ELEMENT");
  EXPECT_EQ(MessageOf(folder.Write("b.xml", "\n<robot/>")),
            at + "/b.xml:2:1: the root element is <robot>; a model is a <mujoco>");
  EXPECT_EQ(MessageOf(folder.Write("c.xml", "<mujoco>\n<include/></mujoco>")),
            at + "/c.xml:2:1: <include> without a file");
  EXPECT_EQ(MessageOf(folder.Write("d.xml", "<mujoco>\n<include file='d.xml'/></mujoco>")),
            at + "/d.xml:2:1: d.xml is included a second time");
  EXPECT_EQ(
      MessageOf(folder.Write("e.xml", "<mujoco><asset>\n<mesh file='x.stl'/></asset></mujoco>")),
      at + "/e.xml:2:1: <mesh> refers to " + at + "/x.stl, which is no file");
}

}  // namespace
}  // namespace trackbed
