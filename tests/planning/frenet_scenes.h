#pragma once

#include <vector>

#include "tests/geometry/random.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// Returns a straight road of 200 m along x.
inline Path StraightRoad() {
  return Path({0.0, 0.0, 0.0}, {{200.0, 0.0, 1}});
}

/// Returns a road with bends to both sides. The curvature is continuous and at most 0.03 1/m.
inline Path BentRoad() {
  return Path({2.0, 1.0, 0.3}, {{15.0, 0.0, 1, 0.002},
                                {20.0, 0.03, 1, 0.0},
                                {30.0, 0.03, 1, -0.002},
                                {20.0, -0.03, 1, 0.0},
                                {15.0, -0.03, 1, 0.002},
                                {60.0, 0.0, 1, 0.0}});
}

/// Returns a request for a car on the path that drives at its planned speed.
inline FrenetRequest OnPath(double speed) {
  FrenetRequest request;
  request.vehicle = ReferenceCar();
  request.speed = {speed, 2.0, 3.0};
  request.start.s_rate = speed;
  request.goal = KeepSpeed{speed};
  return request;
}

/// Returns a standing box at the station `s` and the lateral offset `d` of a path, aligned with the
/// path.
inline MovingBox BoxAt(const Path& path, double s, double d, double length = 2.0,
                       double width = 1.5) {
  const Pose2 at = path.At(s).pose;
  const Vec2 center = at.position() + d * LeftNormal(Direction(at.yaw));
  return {{{center.x(), center.y(), at.yaw}, length, width}, {0.0, 0.0}};
}

/// Returns a few random boxes ahead of the car. Some of the boxes move.
inline std::vector<MovingBox> RandomBoxes(Random& random, const Path& path) {
  std::vector<MovingBox> boxes;
  for (int i = random.Below(4); i >= 0; --i) {
    boxes.push_back(BoxAt(path, random.Uniform(12.0, 45.0), random.Uniform(-4.0, 4.0),
                          random.Uniform(0.5, 4.0), random.Uniform(0.5, 2.0)));
    if (random.Below(3) == 0) {
      boxes.back().velocity = {random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0)};
    }
  }
  return boxes;
}

}  // namespace trackbed
