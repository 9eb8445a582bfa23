#include "trackbed/sim/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/file_name.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string ErrorMessage(const std::filesystem::path& file) {
  return ErrorText([&] { ComposeScene(file, {}); });
}

/// A binary STL file: a header, the triangle count, and one triangle whose points coincide.
std::string Triangle() {
  return std::string(80, ' ') + std::string("\1\0\0\0", 4) + std::string(50, '\0');
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

TEST(ComposeScene, SetsTheSteeringRate) {
  const auto file = FindModel("bmw320i", "");
  const Scene scene = ComposeScene(file, {.steering_rate = 0.75});
  EXPECT_EQ(CarModel(scene, "bmw320i").params().steering_rate, 0.75);
  EXPECT_EQ(CarModel(ComposeScene(file, {}), "bmw320i").params().steering_rate, 0.4);
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
  const std::string stl = Triangle();
  folder.Write("shapes/body.stl", stl);
  const Scene scene = ComposeScene(file, {});
  ASSERT_EQ(scene.assets.size(), 1U);
  EXPECT_EQ(scene.assets[0].name, "asset0_body.stl");
  EXPECT_EQ(scene.assets[0].content, stl);
  EXPECT_THAT(scene.xml, HasSubstr("file=\"asset0_body.stl\""));
  EXPECT_THAT(scene.xml, HasSubstr("name=\"body\""));  // MuJoCo's default name
  EXPECT_THAT(scene.xml, Not(HasSubstr("meshdir")));

  WriteScene(scene, folder.path() / "model.xml");
  EXPECT_EQ(ReadFile(folder.path() / "model.xml"), scene.xml);
  EXPECT_EQ(ReadFile(folder.path() / "asset0_body.stl"), stl);
}

TEST(ComposeScene, GivesAssetsNamesThatFoldersTake) {
  const TempFolder folder;
  for (const std::string& name :
       {std::string(190, 'x') + ".stl", std::string("a b$(touch c).stl"),
        std::string("\xff\xfe.stl"), std::string("caf\xc3\xa9.stl"), std::string("a:b.stl")}) {
    std::filesystem::remove_all(folder.path() / "out");
    folder.Write(name, Triangle());
    const auto file =
        folder.Write("car.xml", "<mujoco><asset><mesh file=\"" + name + "\"/></asset></mujoco>");
    const Scene scene = ComposeScene(file, {});
    ASSERT_EQ(scene.assets.size(), 1U);
    EXPECT_TRUE(IsFileName(scene.assets[0].name)) << name;
    EXPECT_TRUE(scene.assets[0].name.ends_with(".stl")) << name;
    std::filesystem::create_directory(folder.path() / "out");
    WriteScene(scene, folder.path() / "out/model.xml");
    EXPECT_EQ(ReadFile(folder.path() / "out" / scene.assets[0].name), Triangle()) << name;
  }
}

TEST(WriteScene, ReplacesNoFileButTheOneThatIsNamed) {
  const TempFolder folder;
  const Scene scene{.xml = "<mujoco/>", .assets = {{"asset0_body.stl", "new"}}};
  const auto model = folder.Write("model.xml", "old");
  WriteScene(scene, model);
  WriteScene(scene, model);  // the same content
  EXPECT_EQ(ReadFile(model), "<mujoco/>");
  const auto asset = folder.Write("asset0_body.stl", "mine");
  EXPECT_THROW(WriteScene(scene, model), RunError);
  EXPECT_EQ(ReadFile(asset), "mine");
  std::filesystem::remove(asset);
  const auto elsewhere = folder.Write("elsewhere", "mine");
  std::filesystem::create_symlink(elsewhere, asset);
  EXPECT_THROW(WriteScene(scene, model), RunError);
  EXPECT_EQ(ReadFile(elsewhere), "mine");
}

TEST(ComposeScene, NamesFileAndLineOfWhatIsWrong) {
  const TempFolder folder;
  const std::string at = folder.path().string();
  EXPECT_EQ(ErrorMessage(folder.path() / "none.xml"), at + "/none.xml: no such file");
  EXPECT_EQ(ErrorMessage(folder.Write("a.xml", "<mujoco>\n<body>\n</mujoco>")),
            at + "/a.xml:2: not XML: element not closed, or closed by another name");
  EXPECT_EQ(ErrorMessage(folder.Write("b.xml", "\n<robot/>")),
            at + "/b.xml:2: root element is <robot>, of URDF; must be <mujoco>. `trackbed model " +
                at + "/b.xml --adapt -o car.xml` makes a car file of it");
  EXPECT_EQ(ErrorMessage(folder.Write("c.xml", "<mujoco>\n<include/></mujoco>")),
            at + "/c.xml:2: <include> without a file");
  EXPECT_EQ(ErrorMessage(folder.Write("d.xml", "<mujoco>\n<include file='d.xml'/></mujoco>")),
            at + "/d.xml:2: d.xml is included twice");
  EXPECT_EQ(
      ErrorMessage(folder.Write("e.xml", "<mujoco><asset>\n<mesh file='x.stl'/></asset></mujoco>")),
      at + "/e.xml:2: <mesh> refers to " + at + "/x.stl, which does not exist");
}

TEST(ComposeScene, SaysInPlainWordsWhatIsNoXml) {
  const TempFolder folder;
  const auto message = [&](const std::string& xml) {
    const std::string file = folder.Write("a.xml", xml).string();
    return ErrorMessage(file).substr(file.size());
  };
  EXPECT_EQ(message(""), ": the file is empty; expected a <mujoco> element");
  EXPECT_EQ(message("speed: 3\n"), ":1: not XML: text without a following element");
  EXPECT_EQ(message("<mujoco>\n<=/></mujoco>"),
            ":2: not XML: element not of the form <name attribute=\"value\">");
  EXPECT_EQ(message("<mujoco>\n<body name=x/></mujoco>"),
            ":2: not XML: attribute not of the form name=\"value\", given twice, or cut off");
  EXPECT_EQ(message("<mujoco>\n<!-- </mujoco>\n"), ":2: not XML: comment not closed by -->");
  EXPECT_EQ(message("<mujoco>\n<![CDATA[ </mujoco>\n"),
            ":2: not XML: CDATA section not closed by ]]>");
  EXPECT_EQ(message("<mujoco>\n<?x </mujoco>\n"),
            ":2: not XML: declaration <?...?> not closed or not at the start");
  EXPECT_EQ(message("<mujoco>\n<!x </mujoco"), ":2: not XML: declaration <!...> not closed");
  std::string deep = "<mujoco>";
  for (int i = 0; i < 1000; ++i) {
    deep += "<body>";
  }
  EXPECT_EQ(message(deep), ":1: not XML: elements are nested too deeply");
}

TEST(LineInCarFile, IsThatOfTheElementInTheCarsOwnFile) {
  const TempFolder folder;
  const auto file = folder.Write("car.xml",
                                 "<mujoco>\n\n<!-- a\nb -->\n<include file='part.xml'/>\n"
                                 "<size njmax='7'/>\n<worldbody><body\n/></worldbody></mujoco>");
  folder.Write("part.xml", "<mujoco><compiler/>\n<visual/></mujoco>");
  const Scene scene = ComposeScene(file, {});
  const auto line_of = [&](const char* text) {
    const auto end = scene.xml.begin() + static_cast<std::ptrdiff_t>(scene.xml.find(text));
    return static_cast<int>(std::count(scene.xml.begin(), end, '\n')) + 1;
  };
  EXPECT_EQ(LineInCarFile(scene, line_of("<mujoco")), 1);
  EXPECT_EQ(LineInCarFile(scene, line_of("<size")), 6);
  EXPECT_EQ(LineInCarFile(scene, line_of("<worldbody")), 7);
  EXPECT_EQ(LineInCarFile(scene, line_of("<body")), 7);
  EXPECT_NE(line_of("<body"), 7);
  EXPECT_EQ(LineInCarFile(scene, line_of("<compiler")), 0);  // from an included file
  EXPECT_EQ(LineInCarFile(scene, line_of("<option")), 0);    // added by Trackbed
  EXPECT_EQ(LineInCarFile(scene, 1000), 0);
  EXPECT_EQ(LineInCarFile(scene, 0), 0);
}

}  // namespace
}  // namespace trackbed
