#include "src/report/road_data.h"

#include <vector>

#include "src/report/numbers.h"
#include "trackbed/road_network/road_paint.h"

namespace trackbed {
namespace {

nlohmann::ordered_json PointsJson(const std::vector<Vec2>& points) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Vec2& point : points) {
    json.push_back(Rounded(point.x()));
    json.push_back(Rounded(point.y()));
  }
  return json;
}

}  // namespace

nlohmann::ordered_json RoadsJson(const RoadNetwork& network) {
  // spacing of points along a line [m]; the polyline deviates by 3 cm from an arc with a radius of
  // 10 m
  constexpr double kSpacing = 1.5;
  return RoadsJson(PaintRoads(network, kSpacing));
}

nlohmann::ordered_json RoadsJson(const RoadPaint& paint) {
  nlohmann::ordered_json json{{"bands", nlohmann::ordered_json::array()},
                              {"lines", nlohmann::ordered_json::array()}};
  for (const PavedBand& band : paint.bands) {
    json["bands"].push_back({{"left", PointsJson(band.left)}, {"right", PointsJson(band.right)}});
  }
  for (const PaintedLine& line : paint.lines) {
    json["lines"].push_back({{"points", PointsJson(line.points)},
                             {"width", Rounded(line.width)},
                             {"yellow", line.yellow}});
  }
  return json;
}

}  // namespace trackbed
