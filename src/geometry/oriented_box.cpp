#include "trackbed/geometry/oriented_box.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>

namespace trackbed {
namespace {

using Point = boost::geometry::model::d2::point_xy<double>;
using Polygon = boost::geometry::model::polygon<Point, false, true>;  // counter-clockwise, closed

Polygon PolygonOf(const OrientedBox& box) {
  Polygon polygon;
  for (const Vec2& corner : box.Corners()) {
    polygon.outer().emplace_back(corner.x(), corner.y());
  }
  polygon.outer().push_back(polygon.outer().front());
  return polygon;
}

}  // namespace

std::array<Vec2, 4> OrientedBox::Corners() const {
  const double x = 0.5 * length;
  const double y = 0.5 * width;
  return {ToWorld(centre, {x, y}), ToWorld(centre, {-x, y}), ToWorld(centre, {-x, -y}),
          ToWorld(centre, {x, -y})};
}

double Distance(const OrientedBox& a, const OrientedBox& b) {
  return boost::geometry::distance(PolygonOf(a), PolygonOf(b));
}

}  // namespace trackbed
