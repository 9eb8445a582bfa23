#include "src/scenario/cross_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

class CrossCheck {
 public:
  CrossCheck(const Scenario& scenario, const std::function<bool(const std::string&)>& could_read)
      : scenario_(scenario), could_read_(could_read) {}

  std::vector<std::pair<std::string, std::string>> Run() {
    CheckMission();
    CheckCourse();
    CheckSmoothing();
    CheckAvoider();
    CheckReplan();
    CheckSpeedOverTime();
    CheckOptimalSteering();
    CheckSteps();
    CheckPicture();
    if (CouldRead({"drive.plants"})) {
      CheckPlants();
    }
    CheckBetween();
    CheckGround();
    CheckGusts();
    CheckObstacles();
    CheckDisturbances();
    CheckWhatIsMeasured();
    CheckManoeuvre();
    CheckMetrics();
    return std::move(found_);
  }

 private:
  using EachExpectation =
      std::function<void(const std::string& key, const PlantExpectation& expectation)>;

  [[nodiscard]] bool CouldRead(std::initializer_list<const char*> keys) const {
    return std::all_of(keys.begin(), keys.end(), could_read_);
  }

  /// The same for keys of the global plan, which may stand in `plan` or in `plan.global`.
  [[nodiscard]] bool CouldReadPlan(std::initializer_list<const char*> keys) const {
    return could_read_("plan.global") &&
           std::all_of(keys.begin(), keys.end(), [&](const std::string& key) {
             return could_read_("plan." + key) && could_read_("plan.global." + key);
           });
  }

  /// A key of the planner of the whole path.
  [[nodiscard]] std::string KeyOfPlan(const char* key) const {
    const bool layers = scenario_.plan->avoid || scenario_.plan->replan;
    return std::string(layers ? "plan.global." : "plan.") + key;
  }

  void Complain(std::string key, std::string message) {
    found_.emplace_back(std::move(key), std::move(message));
  }

  [[nodiscard]] std::string Driven() const {
    return fmt::format("{}", fmt::join(scenario_.drive.plants, ", "));
  }

  void CheckMission() {
    const MissionSpec& mission = scenario_.mission;
    const auto& plan = scenario_.plan;
    if (CouldRead({"mission.waypoints"})) {
      CheckWaypoints();
    }
    if (!CouldReadPlan({"method"})) {
      return;
    }
    const Recording* recording = RecordingOf(scenario_);
    const bool has_start_speed = mission.start.speed ||
                                 !scenario_.control.speed.over_time.empty() ||
                                 (recording != nullptr && !recording->speed.empty()) ||
                                 !CouldRead({"mission.start.speed", "control.speed.over_time",
                                             "control.file", "control.columns"});
    if (mission.speed == 0.0 && CouldRead({"mission.speed"}) && (plan || !has_start_speed)) {
      Complain("mission.speed", "missing");
    }
    if (CouldRead({"control.method"})) {
      const ControllerEntry& controller = ControllerFor(scenario_.control.steering);
      if (controller.needs_plan && !plan) {
        Complain("plan", fmt::format("missing; the controller {} follows a plan", controller.name));
      }
    }
    if (plan && mission.duration) {
      Complain("mission.duration", "with a plan the drive ends at the goal; leave one out");
    }
    if (!plan && !DurationOf(scenario_) &&
        CouldRead({"mission.duration", "control.file", "control.columns"})) {
      Complain("mission.duration", "missing; without a plan there is no goal to stop at");
    }
    const auto* fillet = plan ? std::get_if<FilletOptions>(&plan->global) : nullptr;
    if (fillet != nullptr && CouldReadPlan({"radius", "constraint"}) && !fillet->radius &&
        fillet->constraint == RadiusConstraint::kNone) {
      Complain(KeyOfPlan("constraint"), "'none' needs a radius: nothing else would limit it");
    }
  }

  void CheckCourse() {
    const auto* course =
        scenario_.plan ? std::get_if<CourseOptions>(&scenario_.plan->global) : nullptr;
    if (course == nullptr) {
      return;
    }
    const std::string key = KeyOfPlan("segments");
    if (course->segments.empty() && CouldReadPlan({"segments"})) {
      Complain(key, "a course needs at least one");
    }
    for (std::size_t i = 0; i < course->segments.size(); ++i) {
      const CoursePiece& piece = course->segments[i];
      const std::string own = fmt::format("{}[{}]", key, i);
      if (!could_read_(own) || !could_read_(own + ".curvature") ||
          !could_read_(own + ".curvature_from") || !could_read_(own + ".curvature_to")) {
        continue;
      }
      if (piece.curvature && (piece.curvature_from || piece.curvature_to)) {
        Complain(own, "give curvature, or curvature_to of a ramp, not both");
      } else if (!piece.curvature && !piece.curvature_to) {
        Complain(own, "needs curvature (0 for a straight), or curvature_to of a ramp");
      }
    }
  }

  void CheckSmoothing() {
    if (!scenario_.plan) {
      return;
    }
    if (CouldReadPlan({"data_weight", "smoothness_weight"})) {
      CheckSmoothing(scenario_.plan->global, KeyOfPlan("smoothness_weight"));
    }
    const std::string detour = "plan.replan.detour.";
    if (scenario_.plan->replan && scenario_.plan->replan->detour &&
        CouldRead({"plan.replan.detour.data_weight", "plan.replan.detour.smoothness_weight"})) {
      CheckSmoothing(*scenario_.plan->replan->detour, detour + "smoothness_weight");
    }
  }

  void CheckSmoothing(const PlannerOptions& planner, const std::string& key) {
    const auto* rrt = std::get_if<RrtPlannerOptions>(&planner);
    if (rrt == nullptr) {
      return;
    }
    const double step = rrt->data_weight + 2.0 * rrt->smoothness_weight;
    if (step <= 0.0 || step >= 1.0) {
      Complain(key,
               fmt::format("data_weight + 2 smoothness_weight is {:.4g}; must be above 0 and below "
                           "1, or smoothing does not converge",
                           step));
    }
  }

  void CheckAvoider() {
    const auto& plan = scenario_.plan;
    if (plan && plan->avoid && MayGoBackwards(plan->global) && CouldReadPlan({"method"})) {
      Complain("plan.avoid",
               fmt::format("a plan by {} may go backwards, which cannot be led around "
                           "anything on the way; leave one out",
                           PlannerName(plan->global)));
    }
  }

  void CheckReplan() {
    const auto& plan = scenario_.plan;
    if (!plan || !plan->replan) {
      return;
    }
    const ReplanOptions& replan = *plan->replan;
    if (MayGoBackwards(plan->global) && CouldReadPlan({"method"})) {
      Complain("plan.replan",
               fmt::format("a plan by {} may go backwards; planning again on the way goes "
                           "forwards only: leave one out",
                           PlannerName(plan->global)));
    }
    if (!CouldRead({"plan.replan.along", "plan.replan.along.method", "plan.replan.detour",
                    "plan.replan.detour.method"})) {
      return;
    }
    if (replan.detour && MayGoBackwards(*replan.detour)) {
      Complain("plan.replan.detour.reverse", "a detour goes forwards: leave it out");
    }
    if (!replan.along && !replan.detour) {
      Complain("plan.replan", "needs along, detour or both: nothing else plans again");
    }
    if (!replan.detour && replan.comparator) {
      Complain("plan.replan.comparator", "needs detour: there is nothing else to compare");
    }
    if (replan.detour &&
        CouldRead({"plan.replan.safe_distance", "plan.replan.detour.safe_distance"})) {
      const double own = SafeDistanceOf(*replan.detour);
      if (own < replan.settings.safe_distance) {
        Complain("plan.replan.detour.safe_distance",
                 fmt::format("{:.4g} m is less than plan.replan.safe_distance, {:.4g} m: every "
                             "detour would be blocked",
                             own, replan.settings.safe_distance));
      }
    }
    if (const auto* lists = replan.along ? std::get_if<FrenetOptions>(&*replan.along) : nullptr) {
      CheckNotEmpty("end_times", lists->end_times);
      CheckNotEmpty("end_offsets", lists->end_offsets);
      CheckNotEmpty("speed_factors", lists->speed_factors);
      CheckNotEmpty("station_offsets", lists->station_offsets);
    } else if (const auto* own =
                   replan.along ? std::get_if<LatticeOptions>(&*replan.along) : nullptr) {
      CheckNotEmpty("end_offsets", own->end_offsets);
      CheckNotEmpty("speed_factors", own->speed_factors);
    }
  }

  void CheckNotEmpty(const std::string& key, const std::vector<double>& values) {
    const std::string dotted = "plan.replan.along." + key;
    if (values.empty() && could_read_(dotted)) {
      Complain(dotted, "needs at least one");
    }
  }

  static double SafeDistanceOf(const PlannerOptions& planner) {
    return std::visit(
        [](const auto& options) {
          if constexpr (requires { options.safe_distance; }) {
            return options.safe_distance;
          } else {
            return std::numeric_limits<double>::infinity();
          }
        },
        planner);
  }

  void CheckWaypoints() {
    const std::vector<Vec2>& waypoints = scenario_.mission.waypoints;
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
      if (waypoints[i] == waypoints[i - 1]) {
        Complain(fmt::format("mission.waypoints[{}]", i), "the same point as the one before it");
      }
    }
    if (scenario_.plan && FewestWaypoints(scenario_.plan->global) == 0 && !waypoints.empty() &&
        CouldReadPlan({"method"})) {
      Complain("mission.waypoints", fmt::format("a plan by {} has its own course; leave them out",
                                                PlannerName(scenario_.plan->global)));
    }
    CheckHeadings();
    if (scenario_.plan && waypoints.size() < FewestWaypoints(scenario_.plan->global)) {
      const std::string given = waypoints.empty() ? "none" : std::to_string(waypoints.size());
      Complain("mission.waypoints", fmt::format("{} given; a plan by {} needs at least {}", given,
                                                PlannerName(scenario_.plan->global),
                                                FewestWaypoints(scenario_.plan->global)));
    }
  }

  void CheckHeadings() {
    const MissionSpec& mission = scenario_.mission;
    if (mission.headings.empty() || !CouldRead({"mission.headings"})) {
      return;
    }
    if (mission.headings.size() != mission.waypoints.size()) {
      Complain("mission.headings", fmt::format("{} given for {} waypoints; give one for each",
                                               mission.headings.size(), mission.waypoints.size()));
    }
    if (scenario_.plan && !PlannerFor(scenario_.plan->global).has_headings &&
        CouldReadPlan({"method"})) {
      Complain("mission.headings", fmt::format("a plan by {} does not look at them; leave them out",
                                               PlannerName(scenario_.plan->global)));
    }
  }

  void CheckSpeedOverTime() {
    const Recording* recording = RecordingOf(scenario_);
    if (recording != nullptr && (!recording->speed.empty() || !recording->acceleration.empty())) {
      const SpeedControlOptions& speed = scenario_.control.speed;
      const std::string message = "the recording has the speed or acceleration; leave this out";
      if (!speed.over_time.empty()) {
        Complain("control.speed.over_time", message);
      }
      if (speed.braking) {
        Complain("control.speed.braking", message);
      }
    }
    const Signal& over_time = scenario_.control.speed.over_time;
    const std::string key = "control.speed.over_time";
    if (over_time.empty() || !could_read_(key)) {
      return;
    }
    for (std::size_t i = 1; i < over_time.knots.size(); ++i) {
      const double before = over_time.knots[i - 1].x();
      if (over_time.knots[i].x() <= before) {
        Complain(fmt::format("{}[{}]", key, i), fmt::format("{} s is not after the {} s before it",
                                                            over_time.knots[i].x(), before));
      }
    }
    if (scenario_.plan && CouldReadPlan({"method"})) {
      Complain(key, "with a plan the speed is the plan's; leave one out");
    }
  }

  void CheckOptimalSteering() {
    const auto* options = std::get_if<OptimalSteeringOptions>(&scenario_.control.steering);
    if (options != nullptr &&
        CouldRead({"control.method", "control.weights.position", "control.weights.heading"}) &&
        options->weights.position == 0.0 && options->weights.heading == 0.0) {
      Complain("control.weights", "position and heading are both 0: nothing is left to minimise");
    }
  }

  void CheckSteps() {
    const DriveSpec& drive = scenario_.drive;
    const double steps = drive.control_period / drive.timestep;
    if (CouldRead({"drive.control_period", "drive.timestep"}) &&
        (std::abs(steps - std::round(steps)) > 1e-6 || steps < 0.5)) {
      Complain("drive.control_period",
               fmt::format("{} s is not a whole number of timesteps of {} s", drive.control_period,
                           drive.timestep));
    }
  }

  void CheckPicture() {
    const RenderSpec& render = scenario_.render;
    if (CouldRead({"render.size"}) &&
        (render.width % 2 != 0 || render.height % 2 != 0 || render.height > 4320)) {
      Complain("render.size", fmt::format("{}x{}: both must be even, the height at most 4320",
                                          render.width, render.height));
    }
  }

  /// What is steeper than 45 degrees is a wall, not something to drive over.
  void CheckGround() {
    constexpr double kSteepest = 1.0;
    for (std::size_t i = 0; i < scenario_.world.ground.bumps.size(); ++i) {
      const Bump& bump = scenario_.world.ground.bumps[i];
      const std::string key = fmt::format("world.ground.bumps[{}]", i);
      if (!could_read_(key + ".height") || !could_read_(key + ".length") ||
          !could_read_(key + ".width") || !could_read_(key + ".edge")) {
        continue;
      }
      // The steepest of h cos^2(pi/2 q), q = d/reach, is pi/2 h / reach.
      const auto check = [&](double reach, const char* where) {
        const double steepest = 0.5 * kPi * bump.height / reach;
        if (steepest > kSteepest) {
          Complain(key, fmt::format("rises {:.3g} m per m {}; at most {} can be driven over",
                                    steepest, where, kSteepest));
        }
      };
      check(0.5 * bump.area.length, "along its length");
      check(std::min(bump.edge, 0.5 * bump.area.width), "at its sides");
    }
  }

  void CheckGusts() {
    for (std::size_t i = 0; i < scenario_.world.wind.gusts.size(); ++i) {
      const Gust& gust = scenario_.world.wind.gusts[i];
      const std::string key = fmt::format("world.wind.gusts[{}]", i);
      if (gust.shape == GustShape::kOneMinusCosine && !gust.duration &&
          could_read_(key + ".duration") && could_read_(key + ".shape")) {
        Complain(key, "one_minus_cosine needs a duration; only a step can blow without end");
      }
    }
  }

  void CheckObstacles() {
    for (std::size_t i = 0; i < scenario_.world.obstacles.size(); ++i) {
      const Obstacle& obstacle = scenario_.world.obstacles[i];
      if (obstacle.known_from_time && obstacle.known_from_range) {
        Complain(fmt::format("world.obstacles[{}].known_from", i), "give time or range, not both");
      }
      if (obstacle.moves() && !IsFlat(scenario_.world.ground)) {
        Complain(fmt::format("world.obstacles[{}].velocity", i),
                 "what moves needs level ground; here world.ground is not");
      }
    }
  }

  void CheckDisturbances() {
    const Disturbances& disturb = scenario_.disturb;
    const auto& loss = disturb.speed_loss;
    if (loss && loss->from && loss->station) {
      Complain("disturb.speed_loss", "give from or station, not both");
    }
    const auto& payload = disturb.payload;
    if (payload && payload->mass.has_value() == payload->share.has_value() &&
        CouldRead({"disturb.payload.mass", "disturb.payload.share"})) {
      Complain("disturb.payload", "give either mass or share");
    }
    for (std::size_t i = 0; i < disturb.kicks.size(); ++i) {
      const Kick& kick = disturb.kicks[i];
      const std::string key = fmt::format("disturb.kicks[{}]", i);
      if (kick.displacement.has_value() == kick.impulse.has_value() &&
          could_read_(key + ".displacement") && could_read_(key + ".impulse")) {
        Complain(key, "give either displacement or impulse");
      } else if (kick.displacement && kick.duration) {
        Complain(key + ".duration", "a displacement has none");
      }
    }
  }

  void CheckPlants() {
    if (scenario_.drive.plants.empty()) {
      Complain("drive.plants", "at least one plant is needed");
    }
    for (const auto& [plant, expectation] : scenario_.expect.plants) {
      if (!Drives(scenario_, plant)) {
        Complain("expect." + plant,
                 fmt::format("drive.plants does not drive it; driven: {}", Driven()));
      }
    }
  }

  void CheckBetween() {
    for (std::size_t i = 0; i < scenario_.expect.between.size(); ++i) {
      const BetweenExpectation& between = scenario_.expect.between[i];
      const std::string key = fmt::format("expect.between[{}]", i);
      if (could_read_(key + ".plants")) {
        CheckTwoPlants(key + ".plants", between.plants);
      }
      const auto could_read = [&](const char* bound) { return could_read_(key + "." + bound); };
      if (!between.bounds.any() && could_read("position_max") && could_read("heading_max") &&
          could_read("yaw_rate_max") && could_read("steering_max")) {
        Complain(key, "asks nothing; give position_max, heading_max, yaw_rate_max or steering_max");
      }
    }
  }

  void CheckTwoPlants(const std::string& key, const std::vector<std::string>& plants) {
    if (plants.size() != 2) {
      Complain(key, fmt::format("expected two plants, found {}", plants.size()));
      return;
    }
    for (const std::string& plant : plants) {
      if (CouldRead({"drive.plants"}) && !Drives(scenario_, plant)) {
        Complain(key, fmt::format("drive.plants does not drive {}; driven: {}", plant, Driven()));
      }
    }
  }

  void ForEachExpectation(const EachExpectation& call) {
    call("expect", scenario_.expect.all);
    for (const auto& [plant, expectation] : scenario_.expect.plants) {
      call("expect." + plant, expectation);
    }
  }

  void CheckManoeuvre() {
    const auto& plan = scenario_.plan;
    const bool has_gates = plan && std::holds_alternative<LaneChangePlannerOptions>(plan->global);
    if (scenario_.manoeuvre && std::holds_alternative<LaneChangeOptions>(*scenario_.manoeuvre) &&
        !has_gates && CouldReadPlan({"method"})) {
      Complain("manoeuvre", "a lane change needs gates; plan: {method: lane_change} has them");
    }
    if (scenario_.manoeuvre && CouldRead({"manoeuvre.fit_from", "manoeuvre.fit_to"})) {
      std::visit([this](const auto& options) { CheckFit(options); }, *scenario_.manoeuvre);
    }
  }

  template <typename Options>
  void CheckFit(const Options& options) {
    if constexpr (requires { options.fit_from; }) {
      if (options.fit_from >= options.fit_to) {
        Complain("manoeuvre.fit_to", fmt::format("{} m/s^2 is not above fit_from, {} m/s^2",
                                                 options.fit_to, options.fit_from));
      }
    }
  }

  void CheckMetrics() {
    ForEachExpectation([&](const std::string& key, const PlantExpectation& expectation) {
      for (std::size_t i = 0; i < expectation.metrics.size(); ++i) {
        const MetricExpectation& metric = expectation.metrics[i];
        const std::string own = fmt::format("{}.metrics[{}]", key, i);
        if (!metric.min && !metric.max && !metric.equals && could_read_(own + ".min") &&
            could_read_(own + ".max") && could_read_(own + ".equals")) {
          Complain(own, "asks nothing; give min, max or equals");
        }
        if (metric.min && metric.max && *metric.min > *metric.max) {
          Complain(own, fmt::format("min {} is above max {}", *metric.min, *metric.max));
        }
      }
    });
  }

  /// Without a path or obstacles there is nothing to measure.
  void CheckWhatIsMeasured() {
    const bool has_path = scenario_.plan || !CouldReadPlan({"method"});
    const bool has_obstacles =
        !scenario_.world.obstacles.empty() || !CouldRead({"world.obstacles"});
    ForEachExpectation([&](const std::string& key, const PlantExpectation& expectation) {
      if (!has_path && (expectation.reach_goal || expectation.max_cross_track ||
                        expectation.rms_cross_track || expectation.max_heading_error)) {
        Complain(key, "without a plan there is no goal and no path to be off");
      }
      if (!has_obstacles && (expectation.min_clearance || expectation.collision.value_or(false))) {
        Complain(key, "without world.obstacles there is nothing to be clear of or to hit");
      }
    });
  }

  const Scenario& scenario_;
  const std::function<bool(const std::string&)>& could_read_;
  std::vector<std::pair<std::string, std::string>> found_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> CrossProblems(
    const Scenario& scenario, const std::function<bool(const std::string& key)>& could_read) {
  return CrossCheck(scenario, could_read).Run();
}

bool Drives(const Scenario& scenario, const std::string& plant) {
  const auto& plants = scenario.drive.plants;
  return std::find(plants.begin(), plants.end(), plant) != plants.end();
}

}  // namespace trackbed
