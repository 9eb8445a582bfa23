#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/render/pictures.h"
#include "tests/road_network/documents.h"

namespace trackbed::render {
namespace {

TEST_F(FilmSceneTest, ARoadNetworkHasPavementAndPaintWhereTheFileSays) {
  RoadText road;
  road.geometry = "<geometry s='0' x='-20' y='0' hdg='0' length='100'><line/></geometry>";
  const std::string width = "<width sOffset='0' a='3.5' b='0' c='0' d='0'/>";
  road.lanes = "<laneSection s='0'><left><lane id='1' type='driving'>" + width +
               "<roadMark sOffset='0' type='solid' color='white' width='0.6'/></lane></left>"
               "<center><lane id='0'><roadMark sOffset='0' type='solid' color='yellow' "
               "width='0.6'/></lane></center><right><lane id='-1' type='driving'>" +
               width + "</lane></right></laneSection>";
  folder_.Write("road_network.xodr", Document(road.Xml()));
  folder_.Write("scenario.resolved.yaml", "world: {road_network: road_network.xodr}\n");
  overlays_ = {"road"};
  const Image image = Picture("top", 1.0);
  // The camera `top` sees 20 m per picture height. A pixel is 0.11 m and the paint 0.6 m wide.
  for (const double x : {-2.0, 10.0}) {
    for (const double y : {-1.75, 1.75}) {
      const std::array<int, 3> asphalt = At(image, x, y);
      const auto [least, most] = std::minmax_element(asphalt.begin(), asphalt.end());
      EXPECT_LT(*most - *least, 20) << x << ", " << y;
      EXPECT_LT(*most, kWhite) << x << ", " << y;
    }
    EXPECT_GT(At(image, x, 3.5)[2], kWhite - 10) << x;
    const std::array<int, 3> yellow = At(image, x, 0.0);
    EXPECT_GT(yellow[0], yellow[2] + 80) << x;
    // Beside the road, which is paved up to 3.5 m to the right, is grass.
    const std::array<int, 3> grass = At(image, x, -6.0);
    EXPECT_GT(grass[1], grass[2] + 15) << x;
  }
}

}  // namespace
}  // namespace trackbed::render
