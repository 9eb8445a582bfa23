#include "trackbed/planning/frenet/road_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/frenet/lattice.h"
#include "trackbed/track/track_file.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr double kRing = 50.0;  // radius of the center line [m]

Track Ring(double right, double left) {
  return Track(RingPoints(kRing, 126, right, left));
}

/// Returns a path of one lap on a circle around the origin.
Path CircleOf(double radius) {
  return Path({radius, 0.0, 0.5 * kPi}, {{2.0 * kPi * radius, 1.0 / radius, 1}});
}

/// Returns a path of one lap along the center line of a track.
Path CenterOf(const Track& track) {
  std::vector<CurvePoint> points;
  for (double s = 0.0; s < track.length(); s += 0.5) {
    const PathPoint at = track.At(s);
    points.push_back({s, at.pose.yaw, at.curvature});
  }
  return Path(track.At(0.0).pose, SegmentsThrough(points));
}

Track Kidney() {
  return ReadTrack(std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios/tracks/kidney.csv");
}

double DistanceFrom(const TrackEdgeLine& edge, const Vec2& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const Vec2& a = edge[i];
    const Vec2 along = edge[(i + 1) % edge.size()] - a;
    const double part = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (point - a - part * along).norm());
  }
  return nearest;
}

/// Returns points along the sides of a footprint.
std::vector<Vec2> Sides(const OrientedBox& box) {
  std::vector<Vec2> points;
  for (const double side : {-0.5, 0.5}) {
    for (int i = 0; i <= 40; ++i) {
      points.push_back(ToWorld(box.center, {(i / 40.0 - 0.5) * box.length, side * box.width}));
    }
  }
  return points;
}

TEST(RoadEdges, AreLinearBetweenStations) {
  const RoadEdges edges(2.0, {{3.0, 4.0}, {5.0, 1.0}});
  EXPECT_DOUBLE_EQ(edges.At(0.5).left, 3.5);
  EXPECT_DOUBLE_EQ(edges.At(0.5).right, 3.25);
  for (const double beyond : {2.0, 7.0}) {
    EXPECT_DOUBLE_EQ(edges.At(beyond).left, 5.0);
    EXPECT_DOUBLE_EQ(edges.At(beyond).right, 1.0);
  }
  EXPECT_DOUBLE_EQ(edges.At(-1.0).left, 3.0);
  EXPECT_THROW(RoadEdges(0.0, {{1.0, 1.0}}), InternalError);
  EXPECT_THROW(RoadEdges(1.0, {}), InternalError);
}

TEST(RoadEdges, OfARingAreAsFarAsItsRadiiSay) {
  const Track track = Ring(4.0, 6.0);
  for (const double radius : {kRing, 48.0, 52.0}) {
    const RoadEdges edges = EdgesBeside(CircleOf(radius), track, ReferenceCar(), 0.5);
    for (double s = 0.0; s < 2.0 * kPi * radius; s += 0.3) {
      // The edges are polylines. The points of the edges are 0.5 m apart along the center line, and
      // at most 0.54 m apart on the outer edge. A polyline is therefore at most 0.54^2/(8 x 54) =
      // 0.0007 m inside its circle. The closing error of the center line is 1e-4 m.
      EXPECT_NEAR(edges.At(s).left, radius - (kRing - 6.0) - 0.5, Tolerance(1e-3));
      EXPECT_NEAR(edges.At(s).right, kRing + 4.0 - radius - 0.5, Tolerance(1e-3));
    }
  }
}

TEST(RoadEdges, TellTheFootprintsReachOnARing) {
  // The expected value follows from the largest and the smallest distance between the sides of the
  // footprint and the origin.
  const Track track = Ring(4.0, 6.0);
  const VehicleParams car = ReferenceCar();
  const Path path = CircleOf(kRing);
  const RoadEdges edges = EdgesBeside(path, track, car, 0.0);
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const FrenetState state{.s = random.Uniform(20.0, 280.0),
                            .d = random.Uniform(-5.0, 6.0),
                            .d_slope = random.Uniform(-0.2, 0.2)};
    const auto motion = FromFrenet(path, state);
    ASSERT_TRUE(motion);
    double beyond = -std::numeric_limits<double>::infinity();
    for (const Vec2& point : Sides(FootprintAt(car, motion->pose))) {
      beyond = std::max({beyond, point.norm() - (kRing + 4.0), kRing - 6.0 - point.norm()});
    }
    // On a circle, ReachBeyond has two errors: that of the polylines (see above), and that of
    // sampling each side at five points, 1.1 m apart. If a side is nearest to the center between
    // two of these points, the error is 0.55^2/(2 x 44) = 0.0035 m.
    EXPECT_NEAR(ReachBeyond(edges, car, path.At(state.s), state), beyond, Tolerance(0.005));
  }
}

TEST(RoadEdges, KeepFootprintsAtTheirDistanceFromATrack) {
  const Track track = Kidney();
  const VehicleParams car = ReferenceCar();
  const Path path = CenterOf(track);
  constexpr double kDistance = 0.5;
  const RoadEdges edges = EdgesBeside(path, track, car, kDistance);
  Random random(8);
  int within = 0;
  for (int i = 0; i < 400; ++i) {
    const FrenetState state{.s = random.Uniform(5.0, path.length() - 10.0),
                            .d = random.Uniform(-3.2, 3.2),
                            .d_slope = random.Uniform(-0.1, 0.1)};
    const auto motion = FromFrenet(path, state);
    ASSERT_TRUE(motion);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2& point : Sides(FootprintAt(car, motion->pose))) {
      nearest = std::min({nearest, DistanceFrom(track.left_edge(), point),
                          DistanceFrom(track.right_edge(), point)});
    }
    const double beyond = ReachBeyond(edges, car, path.At(state.s), state);
    if (beyond > 0.3) {
      continue;  // Beyond an edge, `nearest` has the wrong sign.
    }
    within += beyond <= 0.0 ? 1 : 0;
    // Three errors add up. First, the program measures distances along the normal of the path. This
    // normal differs from that of the edge by up to 0.05 rad, so a distance of at most 4 m errs by
    // 0.05^2/2 x 4 m = 0.005 m. Second, the program treats the path as a circle, although its
    // sharpness is up to 0.001 1/m^2. At 3.7 m ahead of the axle, this is an error of 0.0085 m.
    // Third, edges with a curvature of 1/30 1/m are polylines with points 1.1 m apart, which is an
    // error of 0.005 m.
    EXPECT_NEAR(-beyond, nearest - kDistance, Tolerance(0.019)) << state.s << ' ' << state.d;
  }
  EXPECT_GT(within, 100);
}

TEST(RoadEdges, AdmitAnyCarThatIsOnThePath) {
  // No edge is as far away as the wanted distance of 50 m. The limits then equal the outline of a
  // car that is on the path.
  const Track track = Kidney();
  const VehicleParams car = ReferenceCar();
  const Path path = CenterOf(track);
  const RoadEdges edges = EdgesBeside(path, track, car, 50.0);
  for (double s = 0.0; s <= path.length(); s += 0.07) {
    EXPECT_LE(ReachBeyond(edges, car, path.At(s), {.s = s}), 0.0) << s;
    for (const double d : {-0.1, 0.1}) {
      EXPECT_GT(ReachBeyond(edges, car, path.At(s), {.s = s, .d = d}), 0.05) << s;
    }
  }
}

/// A car at 8 m/s on the center line of a ring, with a box in its way.
struct RingScene {
  RingScene(double right, double left) : track(Ring(right, left)), request(OnPath(8.0)) {
    request.start.s = 20.0;
    request.obstacles = {BoxAt(path, 55.0, 0.0)};
    request.edges =
        std::make_shared<const RoadEdges>(EdgesBeside(path, track, request.vehicle, 0.3));
  }
  Track track;
  Path path = CircleOf(kRing);
  FrenetRequest request;
};

void ExpectWithin(const RingScene& scene, const FrenetPlan& plan) {
  ASSERT_TRUE(plan.ok()) << plan.reason;
  double aside = 0.0;
  for (const TrajectoryPoint& point : plan.points) {
    for (const Vec2& corner : FootprintAt(scene.request.vehicle, point.motion.pose).Corners()) {
      // The tolerance for polylines and sampled sides is derived in the previous tests.
      EXPECT_LE(std::abs(corner.norm() - kRing), 4.5 - 0.3 + Tolerance(0.005));
    }
    aside = std::max(aside, std::abs(point.frenet.d));
  }
  EXPECT_GT(aside, 1.5);
}

TEST(FrenetPlans, KeepWithinTheEdges) {
  const RingScene scene(4.5, 4.5);
  ExpectWithin(scene, PlanFrenet(scene.path, scene.request, {}));
  LatticeOptions lattice;
  lattice.spacing = 16.0;
  ExpectWithin(scene, PlanLattice(scene.path, scene.request, lattice));
}

TEST(FrenetPlans, TakeTheSideThatTheEdgesLeave) {
  // To pass the box, the car needs half of the box's width, its own width, and the distances to the
  // box and to the edge, 3.3 m in total. Only one side of the road is that wide.
  const RingScene left(1.5, 4.5);
  const FrenetPlan to_left = PlanFrenet(left.path, left.request, {});
  ASSERT_TRUE(to_left.ok());
  EXPECT_GT(to_left.motion.At(to_left.motion.duration()).d, 0.0);
  const RingScene right(4.5, 1.5);
  const FrenetPlan to_right = PlanFrenet(right.path, right.request, {});
  ASSERT_TRUE(to_right.ok());
  EXPECT_LT(to_right.motion.At(to_right.motion.duration()).d, 0.0);
}

TEST(FrenetPlans, AreNoneWhereTheEdgesLeaveNoRoom) {
  const RingScene scene(2.0, 2.0);
  FrenetOptions options;
  options.speed_factors = {1.0};
  const FrenetPlan plan = PlanFrenet(scene.path, scene.request, options);
  EXPECT_FALSE(plan.ok());
  EXPECT_GT(plan.rejected.Of(Rejection::kRoad), 0);
  RingScene open = scene;
  open.request.edges.reset();
  EXPECT_TRUE(PlanFrenet(open.path, open.request, options).ok());
}

TEST(FrenetPlans, LeadACarBackThatIsBeyondAnEdge) {
  RingScene scene(3.0, 3.0);
  scene.request.obstacles.clear();
  scene.request.start.d = 2.6;  // The car's left side is 0.46 m beyond the edge.
  const FrenetPlan plan = PlanFrenet(scene.path, scene.request, {});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const auto beyond = [&](const TrajectoryPoint& point) {
    return ReachBeyond(*scene.request.edges, scene.request.vehicle, scene.path.At(point.frenet.s),
                       point.frenet);
  };
  const double first = beyond(plan.points.front());
  EXPECT_GT(first, 0.3);
  for (const TrajectoryPoint& point : plan.points) {
    EXPECT_LE(beyond(point), first + 1e-8);
  }
  EXPECT_LE(beyond(plan.points.back()), 0.0);
}

}  // namespace
}  // namespace trackbed
