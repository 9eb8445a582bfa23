#include <trackbed/core/version.h>
#include <trackbed/geometry/pose.h>

#include <cmath>
#include <numbers>
#include <string>

/// A quarter circle to the left of radius 1 ends at (1, 1).
int main() {
  const double quarter = std::numbers::pi / 2;
  const trackbed::Pose2 end = trackbed::MoveOnArc({}, quarter, quarter);
  const bool arrived = std::hypot(end.x - 1, end.y - 1) < 1e-12;  // some roundings of 1e-16
  return arrived && std::string(trackbed::Version()).starts_with(EXPECTED_VERSION) ? 0 : 1;
}
