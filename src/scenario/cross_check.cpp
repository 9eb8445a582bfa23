#include "src/scenario/cross_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/scenario/check_expectations.h"
#include "src/scenario/check_plan.h"
#include "src/scenario/diagnostics.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/playback.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/sim/plant.h"

// Checks conditions that involve several sections of a scenario.
// 1. Each function Check... tests one condition. If the scenario violates the condition, the
//    function adds a problem at the key that the user should change.
// 2. A condition is tested only if its keys could be read, so that a single mistake causes only one
//    error message.
// 3. The function CrossProblems runs all checks of this file. The conditions of a single method,
//    such as a planner, are in the registry entry of the method (`check`).
namespace trackbed {
namespace {

void CheckSpeedOverTime(Diagnostics& c) {
  const Recording* recording = FindRecording(c.scenario);
  if (recording != nullptr && (!recording->speed.empty() || !recording->acceleration.empty())) {
    const SpeedControlOptions& speed = c.scenario.control.speed;
    const std::string message = "not allowed: the recording has speed or acceleration; remove this";
    if (!speed.over_time.empty()) {
      c.AddError("control.speed.over_time", message);
    }
    if (speed.braking) {
      c.AddError("control.speed.braking", message);
    }
  }
  const Signal& over_time = c.scenario.control.speed.over_time;
  const std::string key = "control.speed.over_time";
  if (over_time.empty() || !c.could_read(key)) {
    return;
  }
  for (std::size_t i = 1; i < over_time.knots.size(); ++i) {
    const double before = over_time.knots[i - 1].x();
    if (over_time.knots[i].x() <= before) {
      c.AddError(fmt::format("{}[{}]", key, i), fmt::format("{} s must be above the previous {} s",
                                                            over_time.knots[i].x(), before));
    }
  }
  if (c.scenario.plan && c.CouldReadPlan({"method"})) {
    c.AddError(key, "not allowed with a plan, which sets the speed; remove one");
  }
}

/// Checks rules that concern several options of the controller.
void CheckController(Diagnostics& c) {
  const ControllerOptions& options = c.scenario.control.steering;
  const auto check = ControllerFor(options).check;
  if (check == nullptr || !c.CouldRead({"control.method"})) {
    return;
  }
  const CouldReadKey could_read = [&](const std::string& key) {
    return c.could_read("control." + key);
  };
  for (OptionProblem& problem : check(options, could_read)) {
    c.AddError("control." + problem.key, std::move(problem.message));
  }
}

void CheckTyreFiles(Diagnostics& c) {
  const VehicleSpec& vehicle = c.scenario.vehicle;
  if (vehicle.tyre_file && vehicle.tyre == TyreLaw::kContact && c.could_read("vehicle.tyre")) {
    c.AddError("vehicle.tyre_file",
               "has no effect on MuJoCo's contacts; remove it, or vehicle.tyre: contact");
  }
  if (vehicle.tyre_file_rear && !vehicle.tyre_file) {
    c.AddError("vehicle.tyre_file_rear", "needs vehicle.tyre_file, the file of the front tyres");
  }
}

void CheckAids(Diagnostics& c) {
  const VehicleSpec& vehicle = c.scenario.vehicle;
  if (!vehicle.aids) {
    return;
  }
  const AidOptions& aids = *vehicle.aids;
  for (const std::string& plant : c.scenario.drive.plants) {
    const bool contact = plant == "mujoco" && vehicle.tyre == TyreLaw::kContact;
    if (aids.any() && (contact || plant == "mujoco:contact") &&
        c.CouldRead({"vehicle.tyre", "drive.plants"})) {
      c.AddError("vehicle.aids",
                 fmt::format("not on contact tyres, whose wheels hardly slip below the friction "
                             "limit and bounce beyond it; remove this, or {}",
                             contact ? "vehicle.tyre: contact" : "the plant mujoco:contact"));
    }
  }
  const std::string differential = "vehicle.aids.differential";
  for (const auto& [key, value] : {std::pair("_preload", aids.differential_preload),
                                   std::pair("_ramp", aids.differential_ramp)}) {
    if (value && aids.differential != Differential::kLimitedSlip && c.could_read(differential)) {
      c.AddError(differential + key,
                 "only for vehicle.aids.differential: limited_slip; remove this, or set that");
    }
  }
}

void CheckTrailer(Diagnostics& c) {
  const Scenario& scenario = c.scenario;
  if (!scenario.vehicle.trailer) {
    if (scenario.mission.start.hitch_angle && c.could_read("vehicle.trailer")) {
      c.AddError("mission.start.hitch_angle",
                 "the car has no trailer; remove this, or add "
                 "vehicle.trailer");
    }
    return;
  }
  for (const std::string& plant : scenario.drive.plants) {
    if (plant == "single_track" && c.CouldRead({"drive.plants"})) {
      c.AddError("vehicle.trailer",
                 "not in the plant single_track, which has no hitch; drive the plants kinematic or "
                 "mujoco instead, or remove this");
    }
  }
  if (scenario.plan && MayGoBackwards(scenario.plan->global) && c.CouldReadPlan({"method"})) {
    c.AddError(
        "vehicle.trailer",
        fmt::format("not with the planner {}, whose paths may reverse: no controller keeps a "
                    "trailer from jackknifing in reverse; use a planner of forward paths, "
                    "such as dubins or path_file, or remove this",
                    PlannerFor(scenario.plan->global).name));
  }
}

void CheckSteps(Diagnostics& c) {
  const DriveSpec& drive = c.scenario.drive;
  const double steps = drive.control_period / drive.timestep;
  if (c.CouldRead({"drive.control_period", "drive.timestep"}) &&
      (std::abs(steps - std::round(steps)) > 1e-6 || steps < 0.5)) {
    c.AddError("drive.control_period",
               fmt::format("{} s is not a whole number of timesteps of {} s", drive.control_period,
                           drive.timestep));
  }
}

/// Limits the number of log rows, because each row takes about 1 kB of memory.
void CheckRows(Diagnostics& c) {
  constexpr double kMaxRows = 2e6;
  const DriveSpec& drive = c.scenario.drive;
  for (const auto& [key, period] : {std::pair("drive.control_period", drive.control_period),
                                    std::pair("drive.state_period", drive.state_period)}) {
    const double rows = drive.time_limit / period;
    if (c.CouldRead({"drive.time_limit", key}) && rows > kMaxRows) {
      c.AddError("drive.time_limit",
                 fmt::format("{} s with a row every {} s are {:.7g} rows of a log; must be at most "
                             "{:.7g}: shorten it, or lengthen {}",
                             drive.time_limit, period, rows, kMaxRows, key));
    }
  }
}

void CheckPicture(Diagnostics& c) {
  const RenderSpec& render = c.scenario.render;
  if (c.CouldRead({"render.size"}) &&
      (render.width % 2 != 0 || render.height % 2 != 0 || render.height > 4320)) {
    c.AddError("render.size", fmt::format("{}x{}: both must be even, the height at most 4320",
                                          render.width, render.height));
  }
}

/// Rejects ground steeper than 45 degrees, because steeper ground acts as a wall and not as a
/// driving surface.
void CheckGround(Diagnostics& c) {
  constexpr double kMaxSlope = 1.0;
  for (std::size_t i = 0; i < c.scenario.world.ground.bumps.size(); ++i) {
    const Bump& bump = c.scenario.world.ground.bumps[i];
    const std::string key = fmt::format("world.ground.bumps[{}]", i);
    if (!c.could_read(key + ".height") || !c.could_read(key + ".length") ||
        !c.could_read(key + ".width") || !c.could_read(key + ".edge")) {
      continue;
    }
    // At the distance d from its flat top, the edge of a bump of height h has the height h
    // cos^2(pi/2 d/reach); its largest slope is pi/2 h/reach.
    const auto check = [&](double reach, const char* where) {
      const double steepest = 0.5 * kPi * bump.height / reach;
      if (steepest > kMaxSlope) {
        c.AddError(key,
                   fmt::format("slope {:.3g} {}; must be at most {}", steepest, where, kMaxSlope));
      }
    };
    check(0.5 * bump.area.length, "along its length");
    check(std::min(bump.edge, 0.5 * bump.area.width), "at its sides");
  }
}

void CheckGusts(Diagnostics& c) {
  for (std::size_t i = 0; i < c.scenario.world.wind.gusts.size(); ++i) {
    const Gust& gust = c.scenario.world.wind.gusts[i];
    const std::string key = fmt::format("world.wind.gusts[{}]", i);
    if (gust.shape == GustShape::kOneMinusCosine && !gust.duration &&
        c.could_read(key + ".duration") && c.could_read(key + ".shape")) {
      c.AddError(key, "one_minus_cosine needs a duration; only a step may omit it");
    }
  }
}

/// Largest speed of an obstacle [m/s], equal to the limit of world.obstacles[N].velocity.
constexpr double kMaxObstacleSpeed = 100.0;
/// Permitted difference between poses that must be equal [m], [rad].
constexpr double kSamePlace = 1e-3;

/// Checks the poses through which an obstacle moves.
void CheckMotion(Diagnostics& c, const Obstacle& obstacle, const std::string& key) {
  const std::vector<TimedPose>& motion = obstacle.motion;
  if (motion.empty()) {
    return;
  }
  if (obstacle.velocity != Vec2::Zero()) {
    c.AddError(key + ".velocity", "give velocity or motion, not both");
  }
  if (motion.size() == 1) {
    c.AddError(key + ".motion", "needs at least two poses; give box and velocity instead");
    return;
  }
  for (std::size_t i = 1; i < motion.size(); ++i) {
    const std::string at = fmt::format("{}.motion[{}]", key, i);
    const double duration = motion[i].time - motion[i - 1].time;
    const double distance = (motion[i].pose.position() - motion[i - 1].pose.position()).norm();
    if (!(duration > 0.0)) {
      c.AddError(at + ".time", fmt::format("{} s is not later than {} s of the pose before",
                                           motion[i].time, motion[i - 1].time));
      return;
    }
    if (distance > kMaxObstacleSpeed * duration) {
      c.AddError(at, fmt::format("{:.4g} m from the pose before in {:.4g} s is {:.4g} m/s; must be "
                                 "at most {} m/s",
                                 distance, duration, distance / duration, kMaxObstacleSpeed));
    }
  }
  const Pose2 apart = MotionAt(obstacle, 0.0).displacement;
  if (std::hypot(apart.x, apart.y) > kSamePlace ||
      std::abs(AngleDifference(apart.yaw, 0.0)) > kSamePlace) {
    const Pose2& box = obstacle.footprint.center;
    c.AddError(key + ".box",
               fmt::format("differs from the pose of motion at 0 s; omit x, y and yaw, or give "
                           "x: {:.6g}, y: {:.6g}, yaw: {:.6g}",
                           box.x + apart.x, box.y + apart.y, box.yaw + apart.yaw));
  }
}

void CheckObstacles(Diagnostics& c) {
  for (std::size_t i = 0; i < c.scenario.world.obstacles.size(); ++i) {
    const Obstacle& obstacle = c.scenario.world.obstacles[i];
    if (obstacle.known_from_time && obstacle.known_from_range) {
      c.AddError(fmt::format("world.obstacles[{}].known_from", i), "give time or range, not both");
    }
    const char* motion = obstacle.motion.empty() ? "velocity" : "motion";
    if (obstacle.moves() && !IsFlat(c.scenario.world.ground)) {
      c.AddError(fmt::format("world.obstacles[{}].{}", i, motion),
                 "moving obstacles need a flat world.ground");
    }
    CheckMotion(c, obstacle, fmt::format("world.obstacles[{}]", i));
  }
}

void CheckMap(Diagnostics& c) {
  const auto& map = c.scenario.world.map;
  if (!map) {
    return;
  }
  if (!IsFlat(c.scenario.world.ground)) {
    c.AddError("world.map", "needs a flat world.ground");
  }
  if (c.scenario.plan && c.scenario.plan->avoid && c.CouldReadPlan({"avoid"})) {
    c.AddError("plan.avoid",
               "local planners pass single obstacles, not the walls of world.map; use a global "
               "planner that searches, or plan.replan");
  }
}

void CheckDisturbances(Diagnostics& c) {
  const Disturbances& disturb = c.scenario.disturb;
  const auto& loss = disturb.speed_loss;
  if (loss && loss->from && loss->station) {
    c.AddError("disturb.speed_loss", "give from or station, not both");
  }
  const auto& payload = disturb.payload;
  if (payload && payload->mass.has_value() == payload->share.has_value() &&
      c.CouldRead({"disturb.payload.mass", "disturb.payload.share"})) {
    c.AddError("disturb.payload", "give either mass or share");
  }
  for (std::size_t i = 0; i < disturb.kicks.size(); ++i) {
    const Kick& kick = disturb.kicks[i];
    const std::string key = fmt::format("disturb.kicks[{}]", i);
    if (kick.displacement.has_value() == kick.impulse.has_value() &&
        c.could_read(key + ".displacement") && c.could_read(key + ".impulse")) {
      c.AddError(key, "give either displacement or impulse");
    } else if (kick.displacement && kick.duration) {
      c.AddError(key + ".duration", "not allowed with displacement");
    }
  }
}

void CheckRecord(Diagnostics& c) {
  const auto& record = c.scenario.record;
  if (!record) {
    if (Drives(c.scenario, kRecordedPlant) && c.CouldRead({"drive.plants", "record"})) {
      c.AddError("drive.plants", "recorded needs a record");
    }
    return;
  }
  if (c.scenario.plan && c.CouldReadPlan({"method"})) {
    c.AddError("record", "not allowed with a plan; remove one");
  }
  for (std::size_t i = 0; i < record->windows.size(); ++i) {
    const std::string key = fmt::format("record.windows[{}]", i);
    if (record->data != nullptr && c.could_read(key) &&
        record->windows[i] > record->data->duration()) {
      c.AddError(key, fmt::format("{} s is longer than the record, {:.4g} s", record->windows[i],
                                  record->data->duration()));
    }
    const auto here = record->windows.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(record->windows.begin(), here, *here) != here) {
      c.AddError(key, fmt::format("{} s is listed twice", *here));
    }
  }
}

template <typename Options>
void CheckFit(Diagnostics& c, const Options& options) {
  if constexpr (requires { options.fit_from; }) {
    if (options.fit_from >= options.fit_to) {
      c.AddError("maneuver.fit_to", fmt::format("{} m/s^2 is not above fit_from, {} m/s^2",
                                                options.fit_to, options.fit_from));
    }
  }
}

void CheckManeuver(Diagnostics& c) {
  const auto& plan = c.scenario.plan;
  const bool has_gates = plan && PlannerFor(plan->global).has_gates;
  if (c.scenario.maneuver && std::holds_alternative<LaneChangeOptions>(*c.scenario.maneuver) &&
      !has_gates && c.CouldReadPlan({"method"})) {
    c.AddError("maneuver", fmt::format("lane_change needs gates, given by plan: {{method: {}}}",
                                       NameOfPlannerThat(&PlannerEntry::has_gates)));
  }
  if (c.scenario.maneuver && c.CouldRead({"maneuver.fit_from", "maneuver.fit_to"})) {
    std::visit([&](const auto& options) { CheckFit(c, options); }, *c.scenario.maneuver);
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> CrossProblems(
    const Scenario& scenario, const std::function<bool(const std::string& key)>& could_read) {
  Diagnostics c{.scenario = scenario, .could_read = could_read};
  CheckMissionAndPlan(c);
  CheckSpeedOverTime(c);
  CheckController(c);
  CheckTyreFiles(c);
  CheckAids(c);
  CheckTrailer(c);
  CheckSteps(c);
  CheckRows(c);
  CheckPicture(c);
  CheckGround(c);
  CheckGusts(c);
  CheckObstacles(c);
  CheckMap(c);
  CheckDisturbances(c);
  CheckManeuver(c);
  CheckRecord(c);
  CheckExpectations(c);
  return std::move(c.found);
}

bool Drives(const Scenario& scenario, const std::string& plant) {
  const auto& plants = scenario.drive.plants;
  return std::find(plants.begin(), plants.end(), plant) != plants.end();
}

}  // namespace trackbed
