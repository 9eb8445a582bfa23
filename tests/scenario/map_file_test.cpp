#include "trackbed/scenario/map_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/moving_ai.h"
#include "trackbed/scenario/moving_ai_instances.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

std::filesystem::path Data(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/maps" / name;
}

/// Draws a map as text, with the top row first.
std::string Drawn(const GridMap& map) {
  std::string text;
  for (int row = map.rows; row-- > 0;) {
    for (int column = 0; column < map.columns; ++column) {
      const MapCell cell = map.At(column, row);
      text += cell == MapCell::kOccupied ? '#' : cell == MapCell::kFree ? '.' : '_';
    }
    text += row > 0 ? "/" : "";
  }
  return text;
}

constexpr const char* kYaml =
    "image: IMAGE\nresolution: 0.5\norigin: [1, -2, 0.25]\nnegate: 0\noccupied_thresh: 0.65\n"
    "free_thresh: 0.196\n";

std::string Replaced(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  return text;
}

/// The message of an InputError, without the folder.
std::string MessageOf(const std::function<void()>& read, const TempFolder& folder) {
  try {
    read();
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

class MapFiles : public testing::Test {
 protected:
  /// Reads a map with an image of `content` and the YAML file `yaml`.
  GridMap Read(const std::string& content, const std::string& yaml = kYaml) {
    folder_.Write("image.pgm", content);
    return ReadRosMap(folder_.Write("m.yaml", Replaced(yaml, "IMAGE", "image.pgm")));
  }
  std::string ProblemOf(const std::string& content, const std::string& yaml = kYaml) {
    return MessageOf([&] { Read(content, yaml); }, folder_);
  }
  GridMap ReadMoving(const std::string& text) {
    return ReadMovingAiMap(folder_.Write("m.map", text), 1.0);
  }
  std::string ProblemOfMoving(const std::string& text) {
    return MessageOf([&] { ReadMoving(text); }, folder_);
  }
  TempFolder folder_;
};

const std::string kRamp = "P2 4 3 255  0 64 89 90  205 206 254 255  128 10 20 30";

TEST_F(MapFiles, DecideByTheThresholds) {
  // A pixel with the value v is occupied if d = 1 - v/255 > 0.65. This is true up to v = 89, whose
  // d is 0.651. A pixel is free if d < 0.196. This is true from v = 206 on, whose d is 0.192; for v
  // = 205, d is 0.19608.
  EXPECT_EQ(Drawn(Read(kRamp)), "###_/_.../_###");
  const GridMap map = Read(kRamp);
  EXPECT_EQ(map.columns, 4);
  EXPECT_EQ(map.rows, 3);
  EXPECT_EQ(map.cell, 0.5);
  EXPECT_EQ(map.X_WM.x, 1.0);
  EXPECT_EQ(map.X_WM.y, -2.0);
  EXPECT_EQ(map.X_WM.yaw, 0.25);
  // The last row of the image is row 0 of the map.
  EXPECT_EQ(map.At(0, 0), MapCell::kUnknown);
  EXPECT_EQ(map.At(0, 2), MapCell::kOccupied);
  // With the threshold of newer files, 0.25, the pixel value 205 is free.
  EXPECT_EQ(Drawn(Read(kRamp, Replaced(kYaml, "0.196", "0.25"))), "###_/..../_###");
}

TEST_F(MapFiles, MayBeNegative) {
  // With `negate`, d is v/255. It is above 0.65 from v = 166 on, and below 0.196 up to v = 49,
  // whose d is 0.192.
  for (const char* negate : {"negate: 1", "negate: true"}) {
    EXPECT_EQ(Drawn(Read(kRamp, Replaced(kYaml, "negate: 0", negate))), ".___/####/_...");
  }
  EXPECT_EQ(Drawn(Read(kRamp, Replaced(kYaml, "negate: 0", "negate: false"))), "###_/_.../_###");
}

TEST_F(MapFiles, LeaveEqualToAThresholdUnknown) {
  // With the maximum 4, the pixels 1 and 3 have d = 0.75 and 0.25 exactly, except for the rounding
  // of the numbers in the file.
  const std::string yaml = Replaced(Replaced(kYaml, "0.196", "0.25"), "0.65", "0.75");
  EXPECT_EQ(Drawn(Read("P2 4 1 4 0 1 3 4", yaml)), "#__.");
}

TEST_F(MapFiles, HaveTheSamePixelsInEveryFormatOfImage) {
  const std::string expected = "###_/_.../_###";
  std::string binary = "P5\n# by hand\n4 3\n255\n";
  std::string wide = "P5 4 3 65535\n";
  for (const int v : {0, 64, 89, 90, 205, 206, 254, 255, 128, 10, 20, 30}) {
    binary += static_cast<char>(v);
    wide += std::string(2, static_cast<char>(v));  // 257 v
  }
  EXPECT_EQ(Drawn(Read(binary)), expected);
  EXPECT_EQ(Drawn(Read(wide)), expected);
  EXPECT_EQ(Drawn(Read(ReadFile(Data("ramp.pgm")))), expected);
  for (const char* png : {"gray8.png", "gray16.png", "rgb.png", "palette.png", "rgba.png"}) {
    EXPECT_EQ(Drawn(Read(ReadFile(Data(png)))), expected) << png;
  }
  // Both colors have the mean 100, so d is 1 - 100/255 = 0.61.
  const std::string around_100 = Replaced(Replaced(kYaml, "0.65", "0.609"), "0.196", "0.605");
  EXPECT_EQ(Drawn(Read(ReadFile(Data("colors.png")), Replaced(around_100, "0.609", "0.6070"))),
            "##");
  EXPECT_EQ(Drawn(Read(ReadFile(Data("colors.png")), around_100)), "__");
}

TEST_F(MapFiles, DoNotKnowTransparentPixelsInModeScale) {
  const std::string rgba = ReadFile(Data("rgba.png"));
  EXPECT_EQ(Drawn(Read(rgba, std::string(kYaml) + "mode: trinary\n")), "###_/_.../_###");
  EXPECT_EQ(Drawn(Read(rgba, std::string(kYaml) + "mode: scale\n")), "__#_/_.../_###");
}

TEST_F(MapFiles, MayHaveKeysOfOtherPrograms) {
  EXPECT_EQ(Drawn(Read(kRamp, std::string(kYaml) + "starting_positions: [[1, 2], [3, 4]]\n"
                                                   "map_path: levels/a\n")),
            Drawn(Read(kRamp)));
  EXPECT_THAT(ProblemOf(kRamp, std::string(kYaml) + "mod: scale\n"),
              HasSubstr("unknown key 'mod'; did you mean 'mode'?"));
}

TEST_F(MapFiles, SayWhatIsWrongInTheYaml) {
  const std::string all =
      ProblemOf(kRamp,
                "image: IMAGE\nresolution: -1\norigin: [1, 2]\nnegate: 2\nocupied_thresh: 0.65\n"
                "free_thresh: x\nmode: raw\n");
  EXPECT_THAT(all, HasSubstr("m.yaml:2:13: resolution: -1 is out of range"));
  EXPECT_THAT(all, HasSubstr("m.yaml:3:9: origin: 2 numbers; must be 3: x, y and yaw"));
  EXPECT_THAT(all, HasSubstr("m.yaml:4:9: negate: unknown '2'"));
  EXPECT_THAT(all, HasSubstr("unknown key 'ocupied_thresh'; did you mean 'occupied_thresh'?"));
  EXPECT_THAT(all, HasSubstr("m.yaml:6:14: free_thresh: expected a number, found 'x'"));
  EXPECT_THAT(all, HasSubstr("m.yaml:7:7: mode: unknown 'raw'"));
  EXPECT_THAT(all, HasSubstr("occupied_thresh: missing"));
  EXPECT_EQ(ProblemOf(kRamp, Replaced(kYaml, "0.196", "0.7")),
            "m.yaml:6:14: free_thresh: 0.7 is above occupied_thresh, 0.65");
  EXPECT_THAT(MessageOf([&] { ReadRosMap(folder_.path() / "none.yaml"); }, folder_),
              HasSubstr("none.yaml: No such file"));
  folder_.Write("m.yaml", Replaced(kYaml, "IMAGE", "none.pgm"));
  EXPECT_THAT(MessageOf([&] { ReadRosMap(folder_.path() / "m.yaml"); }, folder_),
              HasSubstr("none.pgm: No such file"));
}

TEST_F(MapFiles, RefuseBrokenImages) {
  EXPECT_EQ(ProblemOf("BM.."), "image.pgm: neither a PGM (P2, P5) nor a PNG image");
  EXPECT_EQ(ProblemOf(""), "image.pgm: neither a PGM (P2, P5) nor a PNG image");
  EXPECT_EQ(ProblemOf("P5"), "image.pgm: no whole number where a PGM file has its width");
  EXPECT_EQ(ProblemOf("P5 -4 3 255\n"),
            "image.pgm: no whole number where a PGM file has its width");
  EXPECT_EQ(ProblemOf("P5 4 3x 255\n"),
            "image.pgm: no whole number where a PGM file has its height");
  EXPECT_EQ(ProblemOf("P5 4 99999999999999999999999 255\n"),
            "image.pgm: no whole number where a PGM file has its height");
  EXPECT_EQ(ProblemOf("P5 0 3 255\n"),
            "image.pgm: an image of 0 x 3 pixels; must be 1 to 20000000 pixels");
  EXPECT_EQ(ProblemOf("P5 4294967296 4294967296 255\n"),
            "image.pgm: an image of 4294967296 x 4294967296 pixels; must be 1 to 20000000 pixels");
  EXPECT_EQ(ProblemOf("P5 4 3 65536\n"), "image.pgm: a largest value of 65536; must be 1 to 65535");
  EXPECT_EQ(ProblemOf("P5 4 3 0\n"), "image.pgm: a largest value of 0; must be 1 to 65535");
  EXPECT_EQ(ProblemOf("P5 4 3 255\nshort"),
            "image.pgm: ends early: 4 x 3 pixels take 12 bytes, found 5");
  EXPECT_EQ(ProblemOf("P5 4000 5000 65535\n"),
            "image.pgm: ends early: 4000 x 5000 pixels take 40000000 bytes, found 0");
  EXPECT_EQ(ProblemOf("P2 2 2 9 1 2 3"),
            "image.pgm: ends early: 2 x 2 pixels take at least 7 bytes, found 5");
  EXPECT_EQ(ProblemOf("P2 2 2 9 1 2 3      "),
            "image.pgm: no whole number where a PGM file has its pixels");
  EXPECT_EQ(ProblemOf("P2 2 2 9 1 2 10 3"),
            "image.pgm: pixel 1 of row 2 has the value 10; must be at most 9");
  EXPECT_EQ(ProblemOf("P5 1 1 9\n\x0a"),
            "image.pgm: pixel 1 of row 1 has the value 10; must be at most 9");
  const std::string png = ReadFile(Data("gray8.png"));
  for (std::size_t size = 8; size < png.size() - 12; ++size) {
    EXPECT_THAT(ProblemOf(png.substr(0, size)), HasSubstr("image.pgm: no PNG image: ")) << size;
  }
  EXPECT_THAT(ProblemOf(ReadFile(Data("vast.png"))), HasSubstr("image.pgm: "));
  EXPECT_EQ(ProblemOf(ReadFile(Data("large.png"))),
            "image.pgm: an image of 5001 x 4000 pixels; must be 1 to 20000000 pixels");
}

TEST_F(MapFiles, AskBeforeTheyReadTheImage) {
  const auto file = folder_.Write("maps/m.yaml", Replaced(kYaml, "IMAGE", "../../secret.pgm"));
  const auto access_error = [](const std::filesystem::path& image) {
    return image.filename() == "secret.pgm" ? std::string("is a secret") : std::string();
  };
  EXPECT_EQ(MessageOf([&] { ReadRosMap(file, access_error); }, folder_),
            "maps/m.yaml: image: ../../secret.pgm is a secret");
}

// map_saver writes the path that the image has on the machine of the one who saved it.
TEST_F(MapFiles, FindTheImageOfAnotherMachineBesideThem) {
  const auto file =
      folder_.Write("m.yaml", Replaced(kYaml, "IMAGE", "/home/somebody/maps/hall.pgm"));
  EXPECT_EQ(MessageOf([&] { ReadRosMap(file, {}); }, folder_),
            "m.yaml: image: /home/somebody/maps/hall.pgm does not exist, and there is no hall.pgm "
            "beside the map file");
  folder_.Write("hall.pgm", "P2 2 1 255 0 255");
  EXPECT_EQ(Drawn(ReadRosMap(file, {})), "#.");
}

TEST_F(MapFiles, OfMovingAiCountFromTheTop) {
  const GridMap map = ReadMoving("type octile\nheight 3\nwidth 4\nmap\n.G..\n@OTS\nW...\n");
  EXPECT_EQ(Drawn(map), "..../####/#...");
  EXPECT_EQ(map.At(0, 0), MapCell::kOccupied);
  EXPECT_EQ(Drawn(ReadMoving("type octile\r\nheight 1\r\nwidth 2\r\nmap\r\n.@\r\n")), ".#");
}

TEST_F(MapFiles, OfMovingAiSayWhereTheyAreWrong) {
  EXPECT_EQ(ProblemOfMoving("type tile\n"), "m.map:1: expected 'type octile', found 'type tile'");
  EXPECT_EQ(ProblemOfMoving(""), "m.map:1: expected 'type octile', found ''");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight x\n"),
            "m.map:2: expected 'height N' with N from 1 to 20000000, found 'height x'");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight 0\n"),
            "m.map:2: expected 'height N' with N from 1 to 20000000, found 'height 0'");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight 9\nwidth 99999999999\n"),
            "m.map:3: expected 'width N' with N from 1 to 20000000, found 'width 99999999999'");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight 9999\nwidth 9999\nmap\n"),
            "m.map:4: 9999 x 9999 cells; must be at most 20000000");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight 2000\nwidth 2000\nmap\n..\n"),
            "m.map:4: 2000 x 2000 cells, but the file has 42 bytes");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight 2\nwidth 3\nmap\n..\n...\n"),
            "m.map:5: a row of 2 cells; must be 3");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight 2\nwidth 3\nmap\n...\n"),
            "m.map:6: a row of 0 cells; must be 3");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight 1\nwidth 3\nmap\n.x.\n"),
            "m.map:5:2: unknown terrain 'x'; must be one of . G @ O T S W");
  EXPECT_EQ(ProblemOfMoving("type octile\nheight 1\nwidth 3\nmap\n...\n\n...\n"),
            "m.map:7: '...' after the last row");
}

TEST_F(MapFiles, InTheirNormalFormReadBackToTheSame) {
  GridMap map = Read(kRamp);
  map.X_WM = {0.1, 1.0 / 3.0, -std::acos(-1.0) / 7.0};
  map.cell = 1.0 / 30.0;
  folder_.Write(kMapPgm, MapPgm(map));
  const GridMap again = ReadRosMap(folder_.Write(kMapYaml, MapYaml(map)));
  EXPECT_EQ(again.cells, map.cells);
  EXPECT_EQ(again.columns, map.columns);
  EXPECT_EQ(again.cell, map.cell);
  EXPECT_EQ(again.X_WM.x, map.X_WM.x);
  EXPECT_EQ(again.X_WM.y, map.X_WM.y);
  EXPECT_EQ(again.X_WM.yaw, map.X_WM.yaw);
}

TEST_F(MapFiles, OfManyWallsAreRefused) {
  std::string text = "type octile\nheight 202\nwidth 202\nmap\n";
  for (int row = 0; row < 202; ++row) {
    for (int column = 0; column < 202; ++column) {
      text += (row + column) % 2 == 0 ? '@' : '.';
    }
    text += '\n';
  }
  folder_.Write("board.map", text);
  EXPECT_THAT(
      MessageOf([&] { ReadMap({.file = "board.map", .cell = 1.0}, folder_.path()); }, folder_),
      HasSubstr("board.map: its blocked cells merge into 20402 rectangular walls; must be "
                "at most 20000"));
}

constexpr const char* kScenario =
    "schema: 1\nname: x\nmission: {speed: 3, waypoints: [[0, 0], [9, 0]]}\n"
    "world: {map: {file: maps/m.yaml, unknown: occupied, height: 2, y: 7}}\n"
    "plan: {method: astar}\n";

TEST_F(MapFiles, StandInScenariosAndTheirResolvedOnes) {
  folder_.Write("maps/image.pgm", kRamp);
  folder_.Write("maps/m.yaml", Replaced(kYaml, "IMAGE", "image.pgm"));
  const Scenario scenario = ParseScenario(kScenario, "test.yaml", folder_.path());
  ASSERT_TRUE(scenario.world.map && scenario.world.map->data);
  const GridMap& map = scenario.world.map->data->map();
  EXPECT_EQ(map.X_WM.x, 1.0);
  EXPECT_EQ(map.X_WM.y, 7.0);  // overrides the file's origin
  // Unknown cells are walls: all cells except three.
  double area = 0.0;
  for (const OrientedBox& wall : MapWalls(scenario.world)) {
    area += wall.length * wall.width;
  }
  EXPECT_EQ(area, 9 * 0.25);
  const std::string once = ResolvedYaml(scenario);
  EXPECT_THAT(once, HasSubstr("file: map.yaml\n"));
  const TempFolder& elsewhere = folder_;
  elsewhere.Write("run/map.yaml", MapYaml(map));
  elsewhere.Write("run/map.pgm", MapPgm(map));
  elsewhere.Write("run/scenario.yaml", once);
  const Scenario again = ParseScenario(once, "resolved.yaml", elsewhere.path() / "run");
  EXPECT_EQ(ResolvedYaml(again), once);
  EXPECT_EQ(again.world.map->data->map().cells, map.cells);
  EXPECT_EQ(MapWalls(again.world).size(), MapWalls(scenario.world).size());
  // Films and reports read the world in this way.
  EXPECT_EQ(MapWalls(ReadWorld(elsewhere.path() / "run/scenario.yaml")).size(),
            MapWalls(scenario.world).size());
}

TEST_F(MapFiles, OfScenariosLieBelowThem) {
  const auto problem = [&](const std::vector<Override>& overrides) {
    return MessageOf(
        [&] { ParseScenario(kScenario, "test.yaml", folder_.path() / "inner", overrides); },
        folder_);
  };
  folder_.Write("image.pgm", kRamp);
  folder_.Write("inner/maps/m.yaml", Replaced(kYaml, "IMAGE", "../../image.pgm"));
  folder_.Write("outside.yaml", Replaced(kYaml, "IMAGE", "image.pgm"));
  EXPECT_THAT(problem({}), HasSubstr("inner/maps/m.yaml: image: ../../image.pgm lies outside of"));
  EXPECT_THAT(problem({"world.map.file=../outside.yaml"}),
              HasSubstr("world.map.file: ../outside.yaml lies outside of"));
  EXPECT_THAT(problem({"world.map={file: maps/m.yaml, cell: 1}"}),
              HasSubstr("world.map.cell: not allowed with a ROS map"));
  EXPECT_THAT(problem({"world.map.file=maps/m.map"}), HasSubstr("world.map.cell: missing"));
  EXPECT_THAT(problem({"world.map={file: maps/m.map, cell: 1}"}), HasSubstr("m.map"));
  folder_.Write("inner/maps/image.pgm", kRamp);
  folder_.Write("inner/maps/m.yaml", Replaced(kYaml, "IMAGE", "image.pgm"));
  EXPECT_THAT(problem({"world.ground.grade.x=0.1"}),
              HasSubstr("world.map: needs a flat world.ground"));
  EXPECT_THAT(problem({"plan={global: {method: fillet}, avoid: {method: bezier}}"}),
              HasSubstr("plan.avoid: local planners pass single obstacles"));
  EXPECT_EQ(problem({"expect.min_clearance=0.1"}), "");
}

// There is no relative path from a relative folder to an absolute file name.
TEST_F(MapFiles, OfRelativeFoldersLieBelowThemToo) {
  folder_.Write("secret.pgm", kRamp);
  const std::filesystem::path secret = folder_.path() / "secret.pgm";
  folder_.Write("inner/maps/m.yaml", Replaced(kYaml, "IMAGE", secret.string()));
  const std::filesystem::path relative =
      std::filesystem::relative(folder_.path() / "inner", std::filesystem::current_path());
  ASSERT_TRUE(relative.is_relative());
  EXPECT_THAT(MessageOf([&] { ParseScenario(kScenario, "test.yaml", relative); }, folder_),
              HasSubstr("lies outside of"));
  folder_.Write("inner/maps/image.pgm", kRamp);
  folder_.Write("inner/maps/m.yaml", Replaced(kYaml, "IMAGE", "image.pgm"));
  EXPECT_EQ(MessageOf([&] { ParseScenario(kScenario, "test.yaml", relative); }, folder_), "");
}

TEST_F(MapFiles, ReadInstancesOfTheBenchmark) {
  const auto file = folder_.Write(
      "m.scen", "version 1\n0\tm.map\t10\t5\t1\t0\t3\t4\t4.82842712\n7 m.map 10 5 9 4 0 0 9.5\n\n");
  const std::vector<MovingAiInstance> instances = ReadMovingAiInstances(file);
  ASSERT_EQ(instances.size(), 2U);
  EXPECT_EQ(instances[0].map, "m.map");
  EXPECT_EQ(instances[0].start_column, 1);
  EXPECT_EQ(instances[0].start_row, 4);  // from the bottom
  EXPECT_EQ(instances[0].goal_column, 3);
  EXPECT_EQ(instances[0].goal_row, 0);
  EXPECT_EQ(instances[0].length, 4.82842712);
  EXPECT_EQ(instances[1].bucket, 7);
  EXPECT_EQ(instances[1].line, 3);
  const auto problem = [&](const std::string& text) {
    return MessageOf([&] { ReadMovingAiInstances(folder_.Write("m.scen", text)); }, folder_);
  };
  EXPECT_EQ(problem(""), "m.scen: is empty; expected 'version 1'");
  EXPECT_EQ(problem("version 2\n"), "m.scen:1: expected 'version 1', found 'version 2'");
  const std::string all = problem(
      "version 1\n1 m.map 10 5\nx m.map 10 5 1 0 3 4 4.8\n1 m.map 10 5 1 5 3 4 4.8\n"
      "1 m.map 10 5 1 0 3 4 nan\n");
  EXPECT_THAT(all, HasSubstr("m.scen:2: 4 fields; must be 9"));
  EXPECT_THAT(all, HasSubstr("m.scen:3: field 1: 'x' is no whole number"));
  EXPECT_THAT(all, HasSubstr("m.scen:4: start (1, 5) or goal (3, 4) is not on the map"));
  EXPECT_THAT(all, HasSubstr("m.scen:5: field 9: 'nan' is no length"));
}

}  // namespace
}  // namespace trackbed
