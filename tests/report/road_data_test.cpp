#include "src/report/road_data.h"

#include <gtest/gtest.h>

#include "tests/road_network/documents.h"
#include "tests/support/temp_folder.h"
#include "trackbed/road_network/open_drive.h"

namespace trackbed {
namespace {

TEST(RoadData, HasThePavementAndThePaint) {
  RoadText road;
  road.lanes =
      "<laneSection s='0'><center><lane id='0'><roadMark sOffset='0' type='broken' "
      "color='yellow' width='0.15'/></lane></center><right><lane id='-1' type='driving'>"
      "<width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane></right></laneSection>";
  const TempFolder folder;
  const nlohmann::ordered_json roads =
      RoadsJson(ReadOpenDrive(folder.Write("road_network.xodr", Document(road.Xml()))));
  ASSERT_EQ(roads.at("bands").size(), 1U);
  const auto& band = roads.at("bands")[0];
  EXPECT_EQ(band.at("left").size(), band.at("right").size());
  EXPECT_EQ(band.at("left").front(), 0.0);
  EXPECT_EQ(band.at("right").back(), -3.5);
  ASSERT_EQ(roads.at("lines").size(), 12U);  // dashes every 9 m over 100 m
  const auto& dash = roads.at("lines")[1];
  EXPECT_EQ(dash.at("points"), nlohmann::ordered_json({9.0, 0.0, 10.5, 0.0, 12.0, 0.0}));
  EXPECT_EQ(dash.at("width"), 0.15);
  EXPECT_TRUE(dash.at("yellow"));
}

}  // namespace
}  // namespace trackbed
