#include "trackbed/planning/common/limit_profile.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"
#include "trackbed/vehicle/params.h"

// Tests speed profiles at the g-g-v limit against closed forms (friction, power, drag, slope, bank,
// crest), checks the accelerations of random profiles against the diagram, and compares a lap with
// calc_vel_profile of TUM's trajectory_planning_helpers (Heilmeier et al.).
namespace trackbed {
namespace limit_profile_test {

constexpr double kGrip = 0.8;  // Friction coefficient mu.
// Relative tolerance. In each interval, bisection finds the squared speed with a relative error of
// 2^-24. The errors of a few hundred intervals add up.
constexpr double kSearched = 1e-5;

/// Returns the diagram of a point mass that is limited only by friction.
GgvDiagram FrictionCircle(LongitudinalForces forces = {.mass = 1000.0, .rolling_mass = 1000.0}) {
  const double grip = kGrip * kGravity;
  return GgvDiagram(forces, {EllipticSection(grip, grip, grip)});
}

/// Returns stations with equal properties, `h` [m] apart over `length` [m].
std::vector<LimitStation> Alike(double length, double h, LimitStation station) {
  std::vector<LimitStation> stations;
  const auto count = std::lround(length / h);
  for (long i = 0; i <= count; ++i) {
    station.s = length * static_cast<double>(i) / static_cast<double>(count);
    stations.push_back(station);
  }
  return stations;
}

void ExpectAll(const LimitSpeeds& result, double speed) {
  for (const double found : result.speeds) {
    EXPECT_NEAR(found, speed, Tolerance(kSearched * speed));
  }
}

TEST(LimitProfile, KeepsOnACircleWhatFrictionAllows) {
  const double radius = 50.0;
  const double expected = std::sqrt(kGrip * kGravity * radius);
  for (const double share : {1.0, 0.64}) {
    const LimitOptions options{.share = share, .speed = 60.0};
    const auto stations = Alike(300.0, 1.0, {.curvature = -1.0 / radius});
    const LimitSpeeds along =
        LimitSpeedsAlong(stations, FrictionCircle(), options, expected * std::sqrt(share), 60.0);
    const LimitSpeeds around =
        LimitSpeedsAround({stations.begin(), stations.end() - 1}, 300.0, FrictionCircle(), options);
    for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
      const double v = expected * std::sqrt(share);
      EXPECT_NEAR(along.speeds[i], v, Tolerance(kSearched * v));
      EXPECT_NEAR(around.speeds[i], v, Tolerance(kSearched * v));
    }
    EXPECT_NEAR(around.time, 300.0 / (expected * std::sqrt(share)), Tolerance(1e-3));
    EXPECT_FALSE(along.excess);
  }
}

TEST(LimitProfile, SpeedsUpAndBrakesOnAStraightAsFrictionAllows) {
  // From rest, v^2 = 2 mu g s. Braking to rest is the mirror image, so the speed peaks at the
  // middle station.
  const auto stations = Alike(100.0, 0.5, {});
  const LimitSpeeds result =
      LimitSpeedsAlong(stations, FrictionCircle(), {.speed = 90.0}, 0.0, 0.0);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double left = std::min(stations[i].s, 100.0 - stations[i].s);
    const double v = std::sqrt(2.0 * kGrip * kGravity * left);
    EXPECT_NEAR(result.speeds[i], v, Tolerance(kSearched * (1.0 + v)));
  }
  EXPECT_NEAR(result.time, 2.0 * std::sqrt(2.0 * 50.0 / (kGrip * kGravity)), Tolerance(1e-4));
}

TEST(LimitProfile, IsLimitedByPower) {
  // With the constant power P, M v dv/ds = P, so v^3 = v0^3 + 3 P s/M. Each interval uses the force
  // at the faster one of its ends. If the speed changes by dv over an interval, the computed gain
  // in speed is too small by up to the fraction dv/v, and by half of this on average.
  const double power = 80e3;
  const double mass = 1200.0;
  const GgvDiagram car =
      FrictionCircle({.mass = 1150.0, .rolling_mass = mass, .drive_power = power});
  const double start = 15.0;
  double before = 0.0;
  for (const double h : {2.0, 1.0}) {
    const auto stations = Alike(600.0, h, {});
    const LimitSpeeds result = LimitSpeedsAlong(stations, car, {.speed = 90.0}, start, 90.0);
    double worst = 0.0;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      const double v = std::cbrt(std::pow(start, 3) + 3.0 * power * stations[i].s / mass);
      EXPECT_LE(result.speeds[i], v * (1.0 + kSearched));
      worst = std::max(worst, v - result.speeds[i]);
    }
    // In the first interval, dv is P h/(M v0^2) = 0.6 m/s for h = 2 m. The error of the speed is
    // below half of dv.
    EXPECT_LT(worst, Tolerance(0.5 * power * h / (mass * start * start)));
    if (before > 0.0) {
      // The error is proportional to the length h of the intervals.
      EXPECT_NEAR(worst / before, 0.5, Tolerance(0.05));
    }
    before = worst;
  }
}

TEST(LimitProfile, EndsItsAccelerationWhereDragIsAsStrongAsTheMotor) {
  // The drag c v^2 equals the drive force at 40 m/s.
  const GgvDiagram car =
      FrictionCircle({.mass = 1000.0, .rolling_mass = 1000.0, .drive_force = 640.0, .drag = 0.4});
  const LimitSpeeds result =
      LimitSpeedsAlong(Alike(20e3, 5.0, {}), car, {.speed = 90.0}, 10.0, 90.0);
  // The difference between v^2 and its limit falls with exp(-2 c s/m), which is 1e-7 at the end.
  EXPECT_NEAR(result.speeds.back(), 40.0, Tolerance(1e-4));
  // From a higher speed v0, drag alone slows the car down: v = v0 exp(-c s/m).
  const GgvDiagram coasting =
      FrictionCircle({.mass = 1000.0, .rolling_mass = 1000.0, .drive_force = 1e-9, .drag = 0.4});
  const LimitSpeeds slower =
      LimitSpeedsAlong(Alike(1000.0, 0.5, {}), coasting, {.speed = 90.0}, 50.0, 90.0);
  // Each interval uses the drag at one of its ends. Over an interval, the drag changes by the
  // fraction 2 c h/m, and the mean error is half of that.
  EXPECT_NEAR(slower.speeds.back(), 50.0 * std::exp(-0.4), Tolerance(50.0 * 0.4 * 4e-4));
}

TEST(LimitProfile, BrakesAsASlopeAllows) {
  // With tan(theta) = slope, the deceleration along the slope is g (mu cos(theta) + sin(theta)). In
  // plan view, it is multiplied by cos(theta). The speed follows from v^2/2 = deceleration x
  // distance.
  const double slope = -0.2;
  const double cosine = 1.0 / std::hypot(1.0, slope);
  const auto stations = Alike(60.0, 0.5, {.grade = slope});
  const LimitSpeeds result =
      LimitSpeedsAlong(stations, FrictionCircle(), {.speed = 14.0}, 14.0, 0.0);
  const double braking = (kGrip + slope) * kGravity * cosine * cosine;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double v = std::min(14.0, std::sqrt(2.0 * braking * (60.0 - stations[i].s)));
    EXPECT_NEAR(result.speeds[i], v, Tolerance(kSearched * 14.0));
  }
}

TEST(LimitProfile, IsFasterOnABankThatHelps) {
  // In a left bend whose road rises to the right with the slope t = -bank, v^2 = R g (mu + t)/(1 -
  // mu t).
  for (const double bank : {-0.2, 0.0, 0.3}) {
    const double radius = 30.0;
    const auto stations = Alike(50.0, 1.0, {.curvature = 1.0 / radius, .bank = bank});
    const double v = std::sqrt(radius * kGravity * (kGrip - bank) / (1.0 + kGrip * bank));
    const LimitSpeeds result =
        LimitSpeedsAlong(stations, FrictionCircle(), {.speed = 60.0}, v, 60.0);
    ExpectAll(result, v);
  }
}

TEST(LimitProfile, KeepsTheWheelsOnACrest) {
  // The crest reduces the load g + v^2 z_ss, where z_ss is the second derivative of the height. The
  // profile permits a reduction to a twentieth of g.
  const auto stations = Alike(5.0, 1.0, {.crest = -0.02});
  const double v = std::sqrt(0.95 * kGravity / 0.02);
  const LimitSpeeds result = LimitSpeedsAlong(stations, FrictionCircle(), {.speed = 60.0}, v, 60.0);
  ExpectAll(result, v);
}

TEST(LimitProfile, BrakesBeforeIce) {
  // From 30 m on, the road is a bend of radius 40 m with a quarter of the grip. Before the bend,
  // the road is straight and has full grip.
  auto stations = Alike(60.0, 0.5, {});
  for (LimitStation& at : stations) {
    if (at.s >= 30.0) {
      at.curvature = 1.0 / 40.0;
      at.road = 0.25;
    }
  }
  const double on_ice = 0.25 * kGrip * kGravity * 40.0;
  const LimitSpeeds result =
      LimitSpeedsAlong(stations, FrictionCircle(), {.speed = 60.0}, 23.2704, 60.0);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    // The last interval before the ice ends in the bend, where no grip is left for braking.
    const double left = std::max(0.0, 29.5 - stations[i].s);
    const double v = std::sqrt(on_ice + 2.0 * kGrip * kGravity * left);
    EXPECT_NEAR(result.speeds[i], v, Tolerance(kSearched * v)) << stations[i].s;
    if (stations[i].s > 45.0) {
      break;
    }
  }
}

/// Returns the stations of a winding path with random grade, bank and friction.
std::vector<LimitStation> Winding(double length, double h, Random& random) {
  std::vector<LimitStation> stations = Alike(length, h, {});
  for (int bends = 0; bends < 8; ++bends) {
    const double middle = random.Uniform(0.0, length);
    const double width = random.Uniform(10.0, 60.0);
    const double curvature = random.Uniform(-0.06, 0.06);
    const double slope = random.Uniform(-0.05, 0.05);
    for (LimitStation& at : stations) {
      const double x = std::exp(-std::pow((at.s - middle) / width, 2));
      at.curvature += curvature * x;
      at.grade += slope * x;
      at.bank += 0.3 * slope * x;
      at.road = std::max(0.3, at.road - 0.2 * x);
    }
  }
  return stations;
}

GgvDiagram SmallCar() {
  return GgvDiagram({.mass = 1500.0,
                     .rolling_mass = 1540.0,
                     .drive_force = 6000.0,
                     .drive_power = 90e3,
                     .brake_force = 20e3,
                     .rolling_resistance = 150.0,
                     .drag = 0.35,
                     .top_speed = 55.0},
                    {EllipticSection(6.0, 9.0, 8.5)});
}

/// The largest amounts by which accelerations between stations exceed the diagram [m/s^2]. Each
/// acceleration is compared with the diagram at both ends of its interval.
struct Beyond {
  double driving = 0.0;
  double braking = 0.0;
};

Beyond FindBeyond(const std::vector<LimitStation>& stations, const std::vector<double>& speeds,
                  double share) {
  const GgvDiagram car = SmallCar();
  const LongitudinalForces& forces = car.forces();
  Beyond worst;
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    const double a = (speeds[i + 1] * speeds[i + 1] - speeds[i] * speeds[i]) /
                     (2.0 * (stations[i + 1].s - stations[i].s));
    for (const std::size_t k : {i, i + 1}) {
      const LimitStation& at = stations[k];
      // The specific force in a frame that is rotated by the slopes of the ground.
      const Eigen::Vector3d ahead = Eigen::Vector3d(1.0, 0.0, at.grade).normalized();
      const Eigen::Vector3d up = Eigen::Vector3d(-at.grade, -at.bank, 1.0).normalized();
      const double v2 = speeds[k] * speeds[k];
      const Eigen::Vector3d force(a, v2 * at.curvature, kGravity + at.grade * a);
      const double steep = std::hypot(1.0, at.grade);
      const double drag = forces.drag * v2 * steep * steep / forces.mass;
      const TyreRange range = car.TyresAt({.speed = speeds[k] * steep,
                                           .road = at.road,
                                           .load = force.dot(up) / kGravity,
                                           .lateral = force.dot(up.cross(ahead)) / share});
      const double wanted = force.dot(ahead) + drag;
      worst.driving = std::max(worst.driving, wanted - share * range.driving);
      worst.braking = std::max(worst.braking, share * range.braking - wanted);
      const double motor = share * car.DriveForce(speeds[k] * steep);
      const double needed = forces.rolling_mass * a * steep + forces.rolling_resistance +
                            forces.mass * (drag + kGravity * at.grade / steep);
      worst.driving = std::max(worst.driving, (needed - motor) / forces.rolling_mass);
    }
  }
  return worst;
}

TEST(LimitProfile, KeepsWithinTheDiagram) {
  Random random(26);
  for (int run = 0; run < 50; ++run) {
    const auto stations = Winding(800.0, 1.0, random);
    const double share = random.Uniform(0.5, 1.0);
    const LimitSpeeds result = LimitSpeedsAlong(stations, SmallCar(), {.share = share}, 0.0, 0.0);
    ASSERT_FALSE(result.excess);
    const Beyond beyond = FindBeyond(stations, result.speeds, share);
    // The squared speed has a relative error of 2^-24. For a square of 3000 m^2/s^2 and an interval
    // of 1 m, this is an error of 2e-4 m/s^2 in the acceleration. Near the largest lateral force,
    // the available longitudinal force is a square root, which increases the error to 1e-3 m/s^2.
    EXPECT_LT(beyond.driving, Tolerance(2e-3)) << run;
    EXPECT_LT(beyond.braking, Tolerance(2e-3)) << run;
  }
}

TEST(LimitProfile, CannotBeRaisedAnywhere) {
  Random random(27);
  const auto stations = Winding(800.0, 1.0, random);
  const LimitSpeeds result = LimitSpeedsAlong(stations, SmallCar(), {}, 0.0, 0.0);
  for (std::size_t i = 1; i + 1 < stations.size(); i += 7) {
    std::vector<double> raised = result.speeds;
    raised[i] += 0.05;
    const Beyond beyond = FindBeyond(stations, raised, 1.0);
    // If a speed v is raised by 0.05 m/s, the acceleration d(v^2)/(2 h) rises by 0.05 v/h, with the
    // interval h = 1 m. At the top speed of the car, no limit of the acceleration is active.
    EXPECT_TRUE(raised[i] > 55.0 || std::max(beyond.driving, beyond.braking) > 0.02)
        << stations[i].s;
  }
}

TEST(LimitProfile, LimitsTheJerk) {
  Random random(28);
  for (int run = 0; run < 20; ++run) {
    const auto stations = Winding(800.0, 1.0, random);
    const double jerk = random.Uniform(3.0, 40.0);
    const LimitSpeeds free = LimitSpeedsAlong(stations, SmallCar(), {}, 0.0, 0.0);
    const LimitSpeeds smooth = LimitSpeedsAlong(stations, SmallCar(), {.jerk = jerk}, 0.0, 0.0);
    for (std::size_t i = 0; i < stations.size(); ++i) {
      EXPECT_LE(smooth.speeds[i], free.speeds[i] * (1.0 + kSearched));
    }
    for (std::size_t i = 1; i + 1 < stations.size(); ++i) {
      const double before = std::pow(smooth.speeds[i], 2) - std::pow(smooth.speeds[i - 1], 2);
      const double after = std::pow(smooth.speeds[i + 1], 2) - std::pow(smooth.speeds[i], 2);
      // The jerk is da/dt = v da/ds. The tolerance allows for rounding: the jerk limit adds a
      // function of up to 1e7 m^2/s^2 to squared speeds below 3000 m^2/s^2.
      EXPECT_LE(0.5 * std::abs(after - before) * smooth.speeds[i], jerk * (1.0 + Tolerance(1e-5)))
          << run << ", " << stations[i].s;
    }
    const Beyond beyond = FindBeyond(stations, smooth.speeds, 1.0);
    // The jerk limit stops when a squared speed changes by less than 1e-4 of its value. For squares
    // below 2000 m^2/s^2 and an interval of 1 m, the acceleration then errs by up to 0.1 m/s^2.
    EXPECT_LT(beyond.driving, Tolerance(0.1)) << run;
    EXPECT_LT(beyond.braking, Tolerance(0.1)) << run;
  }
}

TEST(LimitProfile, OfALapDoesNotDependOnItsBegin) {
  Random random(29);
  const double length = 900.0;
  auto stations = Winding(length, 1.0, random);
  stations.pop_back();
  for (LimitStation& at : stations) {  // The factor `fade` is 0 at both ends, so the stations form
                                       // a closed lap.
    const double fade = std::pow(std::sin(std::acos(-1.0) * at.s / length), 2);
    at.curvature *= fade;
    at.grade *= fade;
    at.bank *= fade;
    at.road = 1.0 + fade * (at.road - 1.0);
  }
  for (const double jerk : {0.0, 20.0}) {
    const LimitOptions options{.share = 0.9, .jerk = jerk};
    const LimitSpeeds result = LimitSpeedsAround(stations, length, SmallCar(), options);
    auto turned = stations;
    std::rotate(turned.begin(), turned.begin() + 321, turned.end());
    for (std::size_t i = 0; i < turned.size(); ++i) {
      turned[i].s = static_cast<double>(i);
    }
    const LimitSpeeds other = LimitSpeedsAround(turned, length, SmallCar(), options);
    EXPECT_NEAR(other.time, result.time, Tolerance(1e-6 * result.time));
    for (std::size_t i = 0; i < turned.size(); ++i) {
      const double v = result.speeds[(i + 321) % turned.size()];
      EXPECT_NEAR(other.speeds[i], v, Tolerance(kSearched * v)) << i;
    }
  }
}

TEST(LimitProfile, IsThatOfAnotherProgramWithinAPercent) {
  // tests/data/limit_profile/README.md lists the input of the reference program. The reference
  // program uses the force at the start of an interval to accelerate, and one correction step to
  // brake. Both approximations cause errors proportional to the length of the intervals, 1 m.
  const Table lap = ReadCsv(TRACKBED_SOURCE_DIR "/tests/data/limit_profile/lap.csv");
  std::vector<LimitStation> stations;
  for (std::size_t i = 0; i < lap.rows(); ++i) {
    stations.push_back({.s = lap.at(i, 0), .curvature = lap.at(i, 1)});
  }
  const GgvDiagram car({.mass = 1200.0,
                        .rolling_mass = 1200.0,
                        .drive_force = 7500.0,
                        .drive_power = 270e3,
                        .drag = 0.75,
                        .top_speed = 70.0},
                       {EllipticSection(9.0, 9.0, 8.0)});
  const LimitSpeeds own = LimitSpeedsAround(stations, 1500.0, car, {});
  double time = 0.0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double theirs = lap.at(i, 2);
    EXPECT_NEAR(own.speeds[i], theirs, Tolerance(0.01 * theirs)) << i;
    time += 2.0 / (theirs + lap.at((i + 1) % stations.size(), 2));
  }
  EXPECT_NEAR(own.time, time, Tolerance(0.001 * time));
}

TEST(LimitProfile, SaysWhereTheCarComesTooFast) {
  // The car drives at 30 m/s, 20 m before a bend of radius 30 m that permits 15.3 m/s.
  auto stations = Alike(60.0, 0.5, {});
  for (LimitStation& at : stations) {
    at.curvature = at.s >= 20.0 ? 1.0 / 30.0 : 0.0;
  }
  const LimitSpeeds result =
      LimitSpeedsAlong(stations, FrictionCircle(), {.speed = 60.0}, 30.0, 60.0);
  ASSERT_TRUE(result.excess);
  EXPECT_EQ(result.excess->s, 20.0);
  EXPECT_NEAR(result.excess->speed, std::sqrt(900.0 - 2.0 * kGrip * kGravity * 20.0),
              Tolerance(1e-9));
  EXPECT_NEAR(result.excess->allowed, std::sqrt(kGrip * kGravity * 30.0), Tolerance(1e-4));
  // A start speed above the wanted speed is not an error: the car slows down.
  const LimitSpeeds slower =
      LimitSpeedsAlong(Alike(60.0, 0.5, {}), FrictionCircle(), {.speed = 10.0}, 20.0, 10.0);
  EXPECT_FALSE(slower.excess);
  EXPECT_EQ(slower.speeds.front(), 20.0);
  EXPECT_EQ(slower.speeds.back(), 10.0);
}

TEST(LimitProfile, KeepsCaps) {
  auto stations = Alike(60.0, 0.5, {});
  stations[60].cap = 5.0;
  const LimitSpeeds result =
      LimitSpeedsAlong(stations, FrictionCircle(), {.speed = 60.0}, 0.0, 0.0);
  EXPECT_NEAR(result.speeds[60], 5.0, Tolerance(1e-12));
  EXPECT_GT(result.speeds[40], 10.0);
}

TEST(LimitProfile, RejectsNumbersThatAreNone) {
  const GgvDiagram car = FrictionCircle();
  const auto stations = Alike(10.0, 1.0, {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(LimitSpeedsAlong(stations, car, {}, 0.0, 0.0), PreconditionError);  // no speed limit
  EXPECT_THROW(LimitSpeedsAlong(stations, car, {.speed = nan}, 0.0, 0.0), PreconditionError);
  EXPECT_THROW(LimitSpeedsAlong(stations, car, {.share = 0.0, .speed = 1.0}, 0.0, 0.0),
               PreconditionError);
  EXPECT_THROW(LimitSpeedsAlong(stations, car, {.speed = 1.0}, nan, 0.0), PreconditionError);
  EXPECT_THROW(LimitSpeedsAlong({{}}, car, {.speed = 1.0}, 0.0, 0.0), PreconditionError);
  auto bad = stations;
  bad[3].s = bad[2].s;
  EXPECT_THROW(LimitSpeedsAlong(bad, car, {.speed = 1.0}, 0.0, 0.0), PreconditionError);
  bad = stations;
  bad[3].curvature = nan;
  EXPECT_THROW(LimitSpeedsAlong(bad, car, {.speed = 1.0}, 0.0, 0.0), PreconditionError);
  EXPECT_THROW(LimitSpeedsAround(stations, 10.0, car, {.speed = 1.0}), PreconditionError);
}

}  // namespace limit_profile_test
}  // namespace trackbed
