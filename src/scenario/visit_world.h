#pragma once

#include "trackbed/world/world.h"

/// The keys of the section `world`.
namespace trackbed {

inline constexpr Range kSize{.max = 1e4, .above = 0.0};  // [m]
inline constexpr Range kRoadFactor{.max = 10.0, .above = 0.0};
inline constexpr Range kRiseOverRun{.min = -0.5, .max = 0.5};    // 27 degrees
inline constexpr Range kWindSpeed{.min = -100.0, .max = 100.0};  // [m/s]

inline constexpr Key kWorldSection{"world", "", "what the car drives in"};

inline void Visit(KeyVisitor& a, OrientedBox& box) {
  a.Field({"x", "m", "center of the rectangle"}, box.center.x, Need::kRequired, kMap);
  a.Field({"y", "m", "likewise"}, box.center.y, Need::kRequired, kMap);
  a.Field({"yaw", "rad", "direction of its length"}, box.center.yaw, Need::kOptional);
  a.Field({"length", "m", "along its own x axis"}, box.length, Need::kRequired, kSize);
  a.Field({"width", "m", "along its own y axis"}, box.width, Need::kRequired, kSize);
}

inline void Visit(KeyVisitor& a, FrictionPatch& patch) {
  Visit(a, patch.area);
  a.Field({"friction", "", "there, in place of the world's factor"}, patch.friction,
          Need::kRequired, kRoadFactor);
}

/// The keys of `grade`.
struct GradeKeys {
  Vec2& grade;
};

inline void Visit(KeyVisitor& a, GradeKeys& keys) {
  a.Field({"x", "", "rise over run eastward"}, keys.grade.x(), Need::kOptional, kRiseOverRun);
  a.Field({"y", "", "rise over run northward"}, keys.grade.y(), Need::kOptional, kRiseOverRun);
}

inline void Visit(KeyVisitor& a, Bump& bump) {
  Visit(a, bump.area);
  a.Field({"height", "m", "of its top, midway along its length"}, bump.height, Need::kOptional,
          Range{.max = 100.0, .above = 0.0});
  a.Field({"edge", "m", "width over which each side comes down; at most half the width counts"},
          bump.edge, Need::kOptional, kPositive);
}

inline void Visit(KeyVisitor& a, Superelevation& stretch) {
  Visit(a, stretch.area);
  a.Field({"slope", "", "rise over run to its left; negative: it rises to the right"},
          stretch.slope, Need::kRequired, kRiseOverRun);
  a.Field(
      {"run_in", "m", "length over which it comes at either end; at most half the length counts"},
      stretch.run_in, Need::kOptional, kPositive);
}

inline void Visit(KeyVisitor& a, Ground& ground) {
  GradeKeys grade{ground.grade};
  a.Section({"grade", "", "of the plane through the origin that is the ground"}, grade);
  a.List({"bumps", "", "humps on that plane"}, ground.bumps);
  a.List({"side_slopes", "", "stretches that rise from one long side to the other"},
         ground.side_slopes);
}

inline void Visit(KeyVisitor& a, Gust& gust) {
  a.Field({"x", "m/s", "at its strongest, eastward"}, gust.velocity.x(), Need::kOptional,
          kWindSpeed);
  a.Field({"y", "m/s", "likewise, northward"}, gust.velocity.y(), Need::kOptional, kWindSpeed);
  a.Field({"from", "s", "when it begins"}, gust.from, Need::kOptional, kNonNegative);
  a.Field({"duration", "s", "how long it blows; a step without one never ends"}, gust.duration,
          kPositive);
  static const EnumNames<GustShape> shapes{{GustShape::kOneMinusCosine, "one_minus_cosine"},
                                           {GustShape::kStep, "step"}};
  a.Field({"shape", "", "how its strength runs over its duration"}, gust.shape, Need::kOptional,
          shapes);
  a.Section({"area", "", "where it blows, with sharp edges; else everywhere"}, gust.area);
}

inline void Visit(KeyVisitor& a, Wind& wind) {
  a.Field({"x", "m/s", "eastward; where it blows to, not where it comes from"}, wind.velocity.x(),
          Need::kOptional, kWindSpeed);
  a.Field({"y", "m/s", "northward"}, wind.velocity.y(), Need::kOptional, kWindSpeed);
  a.List({"gusts", "", "wind on top of that, for a while or on a stretch"}, wind.gusts);
}

inline void Visit(KeyVisitor& a, World& world) {
  a.Field({"friction", "", "factor on the tyres' own friction coefficient"}, world.friction,
          Need::kOptional, kRoadFactor);
  a.List({"friction_patches", "", "where that factor is another; later ones lie on earlier ones"},
         world.friction_patches);
  a.Section({"ground", "", "how high the road is; else flat, at z = 0"}, world.ground);
  a.Section({"wind", "", "velocity of the air over the ground"}, world.wind);
  a.List({"obstacles", "", "what stands in the way"}, world.obstacles);
}

/// The keys of `box`.
struct BoxKeys {
  Obstacle& obstacle;
};

inline void Visit(KeyVisitor& a, BoxKeys& keys) {
  Visit(a, keys.obstacle.footprint);
  a.Field({"height", "m", "above the ground"}, keys.obstacle.height, Need::kOptional, kSize);
}

/// The keys of `velocity`.
struct VelocityKeys {
  Vec2& velocity;
};

inline void Visit(KeyVisitor& a, VelocityKeys& keys) {
  a.Field({"x", "m/s", "eastward"}, keys.velocity.x(), Need::kOptional, kWindSpeed);
  a.Field({"y", "m/s", "northward"}, keys.velocity.y(), Need::kOptional, kWindSpeed);
}

/// The keys of `known_from`.
struct KnownFromKeys {
  Obstacle& obstacle;
};

inline void Visit(KeyVisitor& a, KnownFromKeys& keys) {
  a.Field({"time", "s", "at this moment of the drive"}, keys.obstacle.known_from_time,
          kNonNegative);
  a.Field({"range", "m", "once the car's outline is this close to it"},
          keys.obstacle.known_from_range, kNonNegative);
}

inline void Visit(KeyVisitor& a, Obstacle& obstacle) {
  BoxKeys keys{obstacle};
  a.Section({"box", "", "a box that stands on the ground"}, keys, Need::kRequired);
  const bool writes = a.mode() == KeyVisitor::Mode::kWrite;
  if (!writes || obstacle.moves()) {
    VelocityKeys velocity{obstacle.velocity};
    a.Section({"velocity", "", "of the box, which does not turn; else it stands"}, velocity);
  }
  if (writes && !obstacle.known_from_time && !obstacle.known_from_range) {
    return;  // an empty section would say no more
  }
  KnownFromKeys known{obstacle};
  a.Section({"known_from", "", "when planners learn of it; else from the start"}, known);
}

}  // namespace trackbed
