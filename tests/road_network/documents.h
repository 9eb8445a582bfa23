#pragma once

#include <fmt/format.h>

#include <string>

#include "trackbed/road_network/open_drive.h"

/// OpenDRIVE documents for the tests.
namespace trackbed {

inline std::string Document(const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<OpenDRIVE>\n<header revMajor=\"1\" revMinor=\"6\"/>\n" +
         content + "\n</OpenDRIVE>\n";
}

inline RoadNetwork ParseNetwork(const std::string& content) {
  return ParseOpenDrive(Document(content), "test.xodr");
}

/// Returns the heights of a road: a + b s + c s^2 [m] at the station s [m].
inline std::string Elevation(double a, double b, double c) {
  return fmt::format(
      "<elevationProfile><elevation s='0' a='{}' b='{}' c='{}' d='0'/></elevationProfile>", a, b,
      c);
}

/// A lane section with one driving lane on each side, each 3.5 m wide.
inline const std::string kTwoLanes =
    "<laneSection s=\"0\">"
    "<left><lane id=\"1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>"
    "</lane></left>"
    "<center><lane id=\"0\" type=\"none\"/></center>"
    "<right><lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" "
    "d=\"0\"/>"
    "</lane></right></laneSection>";

/// The text of the elements of a road. A test can replace each element.
struct RoadText {
  std::string id = "1";
  std::string length = "100";
  std::string attributes{};
  std::string link{};
  std::string geometry =
      "<geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"100\"><line/></geometry>";
  std::string heights{};
  std::string lanes = kTwoLanes;

  [[nodiscard]] std::string Xml() const {
    return fmt::format(
        "<road id=\"{}\" length=\"{}\" "
        "{}>\n<link>{}</link>\n<planView>\n{}\n</planView>\n{}\n<lanes>\n"
        "{}\n</lanes>\n</road>\n",
        id, length, attributes, link, geometry, heights, lanes);
  }
};

}  // namespace trackbed
