#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "src/scenario/visit_map.h"
#include "trackbed/world/world.h"

/// Declares the keys of the section `world` of a scenario.
namespace trackbed {

inline constexpr Range kRoadFactor{.max = 10.0, .above = 0.0};
// Permitted slopes of a road; a slope of 0.5 is an angle of 27 degrees.
inline constexpr Range kSlopeRange{.min = -0.5, .max = 0.5};
inline constexpr Range kWindSpeed{.min = -100.0, .max = 100.0};  // [m/s]

inline constexpr Key kWorldSection{"world", "", "environment of the car"};

inline void Visit(KeyVisitor& a, OrientedBox& box) {
  a.Field({"x", "m", "center of the rectangle"}, box.center.x, Need::kRequired, kPlace);
  a.Field({"y", "m", "center of the rectangle"}, box.center.y, Need::kRequired, kPlace);
  a.Field({"yaw", "rad", "direction of its length"}, box.center.yaw, Need::kOptional, kDirection);
  a.Field({"length", "m", "along its own x axis"}, box.length, Need::kRequired, kSize);
  a.Field({"width", "m", "along its own y axis"}, box.width, Need::kRequired, kSize);
}

inline void Visit(KeyVisitor& a, FrictionPatch& patch) {
  Visit(a, patch.area);
  a.Field({"friction", "", "friction factor here, replaces world.friction"}, patch.friction,
          Need::kRequired, kRoadFactor);
}

/// Keys of the section `grade` in the section `world` of a scenario.
struct GradeKeys {
  Vec2& grade;
};

inline void Visit(KeyVisitor& a, GradeKeys& keys) {
  a.Field({"x", "", "rise over run eastward"}, keys.grade.x(), Need::kOptional, kSlopeRange);
  a.Field({"y", "", "rise over run northward"}, keys.grade.y(), Need::kOptional, kSlopeRange);
}

inline void Visit(KeyVisitor& a, Bump& bump) {
  Visit(a, bump.area);
  a.Field({"height", "m", "height at the middle of its length"}, bump.height, Need::kOptional,
          Range{.max = 100.0, .above = 0.0});
  a.Field({"edge", "m", "width of the ramp at each side; at most half the width"}, bump.edge,
          Need::kOptional, kPositive);
}

inline void Visit(KeyVisitor& a, Superelevation& stretch) {
  Visit(a, stretch.area);
  a.Field({"slope", "", "slope toward the left; negative: toward the right"}, stretch.slope,
          Need::kRequired, kSlopeRange);
  a.Field({"transition_length", "m", "transition length at both ends; at most half the length"},
          stretch.transition_length, Need::kOptional, kPositive);
}

inline void Visit(KeyVisitor& a, Ground& ground) {
  GradeKeys grade{ground.grade};
  a.Section(
      {"grade", "", "slope of the ground plane through the origin (the local one, with `origin`)"},
      grade);
  a.List({"bumps", "", "bumps on the ground plane"}, ground.bumps);
  a.List({"side_slopes", "", "superelevated (banked) sections"}, ground.side_slopes);
}

inline void Visit(KeyVisitor& a, Gust& gust) {
  a.Field({"x", "m/s", "peak velocity, eastward"}, gust.velocity.x(), Need::kOptional, kWindSpeed);
  a.Field({"y", "m/s", "peak velocity, northward"}, gust.velocity.y(), Need::kOptional, kWindSpeed);
  a.Field({"from", "s", "start time"}, gust.from, Need::kOptional, kNonNegative);
  a.Field({"duration", "s", "duration; a step without one does not end"}, gust.duration, kPositive);
  static const EnumNames<GustShape> shapes{{GustShape::kOneMinusCosine, "one_minus_cosine"},
                                           {GustShape::kStep, "step"}};
  a.Field({"shape", "", "velocity profile over the duration"}, gust.shape, Need::kOptional, shapes);
  a.Section({"area", "", "area of the gust; default: everywhere"}, gust.area);
}

inline void Visit(KeyVisitor& a, Wind& wind) {
  a.Field({"x", "m/s", "velocity eastward (direction toward which the wind blows)"},
          wind.velocity.x(), Need::kOptional, kWindSpeed);
  a.Field({"y", "m/s", "northward"}, wind.velocity.y(), Need::kOptional, kWindSpeed);
  a.List({"gusts", "", "gusts added to the constant wind"}, wind.gusts);
}

inline void Visit(KeyVisitor& a, RoadLook& road) {
  a.Field({"width", "m", "between the edge lines; 0: no road"}, road.width, Need::kOptional,
          Range{.min = 0.0, .max = 100.0});
  a.Field({"lanes", "", "number of lanes of equal width"}, road.lanes, Need::kOptional,
          Range{.min = 1, .max = 12});
}

inline void Visit(KeyVisitor& a, World& world) {
  a.Field({"friction", "", "factor on the tyre friction coefficients"}, world.friction,
          Need::kOptional, kRoadFactor);
  a.List({"friction_patches", "", "areas of different friction; later ones override earlier ones"},
         world.friction_patches);
  a.Section({"ground", "", "road surface; default: flat at z = 0"}, world.ground);
  a.Section({"wind", "", "air velocity over the ground"}, world.wind);
  a.List({"obstacles", "", "obstacles"}, world.obstacles);
  a.Section({"map", "", "grid map whose blocked cells are walls"}, world.map);
  a.Section({"road", "",
             "road along the plan in films and reports, without effect on the drive; default: "
             "along plans that do not cross open ground"},
            world.road);
  std::optional<std::string> network =
      world.road_network ? std::optional(world.road_network->file) : std::nullopt;
  a.Field({"road_network", "",
           "OpenDRIVE file of the roads that mission.route leads over, relative to this file"},
          network);
  if (a.mode() == KeyVisitor::Mode::kRead) {
    world.road_network = network ? std::optional(RoadNetworkSpec{*network}) : std::nullopt;
  }
}

/// Whether a motion has at least two poses and increasing times, so that the motion can be
/// evaluated.
inline bool IsPiecewise(const std::vector<TimedPose>& motion) {
  return motion.size() >= 2 && std::adjacent_find(motion.begin(), motion.end(),
                                                  [](const TimedPose& a, const TimedPose& b) {
                                                    return a.time >= b.time;
                                                  }) == motion.end();
}

/// Keys of the section `box` of an obstacle.
struct BoxKeys {
  Obstacle& obstacle;
};

/// Reads the keys of the box of an obstacle that moves through poses. If a coordinate or the yaw of
/// the center is missing, its value is taken from the pose at time 0.
inline void VisitMovingBox(KeyVisitor& a, Obstacle& obstacle) {
  OrientedBox& box = obstacle.footprint;
  box.center = {};
  const Pose2 start = MotionAt(obstacle, 0.0).displacement;
  std::optional<double> x;
  std::optional<double> y;
  std::optional<double> yaw;
  a.Field({"x", "m", "center of the rectangle"}, x, kPlace);
  a.Field({"y", "m", "center of the rectangle"}, y, kPlace);
  a.Field({"yaw", "rad", "direction of its length"}, yaw, kDirection);
  a.Field({"length", "m", "along its own x axis"}, box.length, Need::kRequired, kSize);
  a.Field({"width", "m", "along its own y axis"}, box.width, Need::kRequired, kSize);
  box.center = {x.value_or(start.x), y.value_or(start.y), yaw.value_or(start.yaw)};
}

inline void Visit(KeyVisitor& a, TimedPose& at) {
  a.Field({"time", "s", "simulation time, later than that of the pose before"}, at.time,
          Need::kRequired, kNonNegative);
  a.Field({"x", "m", "center of the box"}, at.pose.x, Need::kRequired, kPlace);
  a.Field({"y", "m", "center of the box"}, at.pose.y, Need::kRequired, kPlace);
  a.Field({"yaw", "rad", "direction of its length"}, at.pose.yaw, Need::kRequired, kDirection);
}

inline void Visit(KeyVisitor& a, BoxKeys& keys) {
  if (a.mode() == KeyVisitor::Mode::kRead && IsPiecewise(keys.obstacle.motion)) {
    VisitMovingBox(a, keys.obstacle);
  } else {
    Visit(a, keys.obstacle.footprint);
  }
  a.Field({"height", "m", "height above the ground"}, keys.obstacle.height, Need::kOptional, kSize);
}

/// Keys of the section `velocity` of an obstacle.
struct VelocityKeys {
  Vec2& velocity;
};

inline void Visit(KeyVisitor& a, VelocityKeys& keys) {
  a.Field({"x", "m/s", "eastward"}, keys.velocity.x(), Need::kOptional, kWindSpeed);
  a.Field({"y", "m/s", "northward"}, keys.velocity.y(), Need::kOptional, kWindSpeed);
}

/// Keys of the section `known_from` of an obstacle.
struct KnownFromKeys {
  Obstacle& obstacle;
};

inline void Visit(KeyVisitor& a, KnownFromKeys& keys) {
  a.Field({"time", "s", "simulation time"}, keys.obstacle.known_from_time, kNonNegative);
  a.Field({"range", "m", "distance from the car's footprint at which it is detected"},
          keys.obstacle.known_from_range, kNonNegative);
}

inline void Visit(KeyVisitor& a, Obstacle& obstacle) {
  const bool writes = a.mode() == KeyVisitor::Mode::kWrite;
  if (!writes || !obstacle.motion.empty()) {
    a.List({"motion", "", "poses through which the box moves; default: constant velocity"},
           obstacle.motion);
  }
  BoxKeys keys{obstacle};
  a.Section({"box", "", "box on the ground"}, keys, Need::kRequired);
  a.Field({"until", "s", "time after which the box is gone; default: never"}, obstacle.until,
          kNonNegative);
  if (!writes || obstacle.velocity != Vec2::Zero()) {
    VelocityKeys velocity{obstacle.velocity};
    a.Section({"velocity", "", "velocity of the box, without rotation; default: static"}, velocity);
  }
  if (writes && !obstacle.known_from_time && !obstacle.known_from_range) {
    return;  // a writer omits the section `known_from` if it is empty
  }
  KnownFromKeys known{obstacle};
  a.Section(
      {"known_from", "", "when the obstacle becomes known to planners; default: from the start"},
      known);
}

}  // namespace trackbed
