#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"

/// The file entries_test.cpp uses these calls of public functions.
namespace properties {

/// A call of a public function that uses `number` for one argument and valid values for all other
/// arguments. The returned number must be finite if the call succeeds, and not finite if the call
/// reports failure.
struct Entry {
  std::string name;
  std::function<double(double number)> call;
};

inline constexpr double kWell = 0.0;
inline const double kNone = std::numeric_limits<double>::quiet_NaN();

inline const trackbed::OrientedBox kBox{{1.0, 2.0, 0.3}, 3.0, 2.0};

inline double SumOf(const trackbed::Pose2& pose) {
  return pose.x + pose.y + pose.yaw;
}
inline double SumOf(const trackbed::Vec2& point) {
  return point.x() + point.y();
}

/// Returns a path of a straight line, a clothoid and an arc.
const trackbed::Path& Bend();

std::vector<Entry> OfGeometry();
std::vector<Entry> OfPaths();
std::vector<Entry> OfSpeeds();
std::vector<Entry> OfCurves();
std::vector<Entry> OfVehicles();
std::vector<Entry> OfWorlds();
std::vector<Entry> OfPlanning();
std::vector<Entry> OfOptimizers();

}  // namespace properties
