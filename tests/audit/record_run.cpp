#include "tests/audit/record_run.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/sim/car_model.h"

namespace audit {
namespace {

using trackbed::Table;

const std::vector<std::string> kPlanColumns{
    "s_m", "x_m", "y_m", "yaw_rad", "curvature_radpm", "speed_mps", "direction"};

/// Adds the rows of a plan as in plan.csv; `from`: time of adoption, as an additional first column.
void AddPlan(Table& table, const trackbed::Plan& plan, std::optional<double> from) {
  const trackbed::Reference& reference = plan.reference;
  for (const trackbed::Stations& leg : trackbed::SplitIntoLegs(reference.path)) {
    const trackbed::Reference part = trackbed::Excerpt(reference, leg);
    for (const trackbed::PathPoint& point : part.path.Sample(0.1)) {
      if (point.s == 0.0 && leg.from > 0.0) {
        continue;  // repeats the end of the previous leg
      }
      std::vector<double> row{leg.from + point.s,
                              point.pose.x,
                              point.pose.y,
                              point.pose.yaw,
                              point.curvature,
                              point.direction * part.speed.SpeedAt(point.s),
                              static_cast<double>(point.direction)};
      if (from) {
        row.insert(row.begin(), *from);
      }
      table.AddRow(row);
    }
  }
}

Table Changes(const trackbed::RunLog& log) {
  std::vector<std::string> columns{"from_t_s"};
  columns.insert(columns.end(), kPlanColumns.begin(), kPlanColumns.end());
  Table table(columns);
  for (const trackbed::PlanChange& change : log.changes) {
    AddPlan(table, change.plan, change.time);
  }
  return table;
}

/// The bound of the check on the overspeed, from the verdict of metrics.json.
std::optional<double> OverspeedBound(const nlohmann::json& verdict, const std::string& plant) {
  for (const nlohmann::json& check : verdict.at("checks")) {
    if (check.at("plant") == plant && check.at("metric") == "overspeed_max") {
      return check.at("bound").get<double>();
    }
  }
  return std::nullopt;
}

/// Whether each new plan of a run says that it exceeds a limit.
std::vector<bool> Kept(const trackbed::RunLog& log) {
  std::vector<bool> kept;
  for (const trackbed::PlanChange& change : log.changes) {
    kept.push_back(std::any_of(
        change.plan.notes.begin(), change.plan.notes.end(),
        [](const std::string& note) { return note.starts_with("infeasible, kept anyway"); }));
  }
  return kept;
}

Car CarFrom(const trackbed::CarModel& model) {
  // Plans are computed for the car without its payload; the payload's mass only affects braking.
  const trackbed::VehicleParams& params = model.unladen();
  Car car{.length = params.length,
          .width = params.width,
          .rear_overhang = params.rear_overhang,
          .wheelbase = params.wheelbase,
          .steering_limit = params.steering_limit,
          .steering_rate = params.steering_rate};
  const trackbed::CarParts& parts = model.parts();
  for (const int tyre : parts.tyre) {
    car.friction = std::max(car.friction, model.get()->geom_friction[3 * tyre]);
  }
  if (parts.tyres) {
    for (const trackbed::MagicFormula& axle : parts.tyres->axle) {
      car.friction = std::max({car.friction, axle.p_dx1, axle.p_dy1});
    }
  }
  car.brake_deceleration = 2.0 * (parts.brake_torque_front + parts.brake_torque_rear) /
                           (params.wheel_radius * params.mass);
  return car;
}

Mission MissionFrom(const trackbed::Scenario& scenario, const trackbed::VehicleParams& vehicle) {
  const trackbed::StartState start = trackbed::InitialState(scenario, vehicle);
  Mission mission{.start = {0.0, start.pose.x, start.pose.y, start.pose.yaw},
                  .start_speed = start.speed,
                  .start_steering = start.steering,
                  .acceleration = scenario.control.speed.acceleration,
                  .time_limit = scenario.drive.time_limit,
                  .timestep = scenario.drive.timestep,
                  .control_period = scenario.drive.control_period,
                  .max_cross_track = scenario.expect.all.max_cross_track,
                  .min_clearance = scenario.expect.all.min_clearance,
                  .leans_on_slope = scenario.disturb.payload.has_value() &&
                                    !trackbed::IsFlat(scenario.world.ground),
                  .road_friction = scenario.world.friction};
  for (const trackbed::Vec2& point : scenario.mission.waypoints) {
    mission.waypoints.push_back({point.x(), point.y()});
  }
  mission.headings = scenario.mission.headings;
  mission.speed = scenario.mission.speed;
  if (!scenario.mission.waypoints.empty()) {
    const trackbed::Vec2& goal = scenario.mission.waypoints.back();
    mission.goal = Point{goal.x(), goal.y()};
  }
  if (!scenario.mission.headings.empty()) {
    mission.goal_heading = scenario.mission.headings.back();
  }
  for (const trackbed::MetricExpectation& metric : scenario.expect.all.metrics) {
    if (metric.metric == "time") {
      mission.max_time = metric.max;
    }
  }
  for (const trackbed::FrictionPatch& patch : scenario.world.friction_patches) {
    const trackbed::OrientedBox& box = patch.area;
    mission.patches.push_back(
        {{{0.0, box.center.x, box.center.y, box.center.yaw}, box.length, box.width, {}},
         patch.friction});
  }
  if (trackbed::IsPlane(scenario.world.ground)) {
    mission.grade = {scenario.world.ground.grade.x(), scenario.world.ground.grade.y()};
  }
  const bool keeps_clear =
      scenario.plan && (trackbed::PlannerFor(scenario.plan->global).keeps_clear);
  for (const trackbed::Obstacle& obstacle : scenario.world.obstacles) {
    const trackbed::OrientedBox& box = obstacle.footprint;
    mission.obstacles.push_back({{0.0, box.center.x, box.center.y, box.center.yaw},
                                 box.length,
                                 box.width,
                                 {obstacle.velocity.x(), obstacle.velocity.y()}});
    // The planner cannot avoid obstacles that become known later.
    const bool known = !obstacle.known_from_time && !obstacle.known_from_range;
    if (keeps_clear && known && !obstacle.moves()) {
      mission.planned_around.push_back(mission.obstacles.size() - 1);
    }
  }
  return mission;
}

Record RecordOfPlan(const trackbed::Scenario& scenario, const trackbed::CarModel& model,
                    const trackbed::RunResult& result) {
  const trackbed::Plan& plan = result.plan;
  Record record{.name = scenario.name,
                .plan_ok = plan.ok(),
                .status = trackbed::ToString(plan.status),
                .reason = plan.reason,
                .blocked = plan.blocked,
                .partial = plan.partial,
                .notes = plan.notes,
                .stops = plan.stops,
                .planning_time = result.planning_time};
  record.car = CarFrom(model);
  record.mission = MissionFrom(scenario, model.unladen());
  record.plan = Table(kPlanColumns);
  if (record.plan_ok) {
    AddPlan(record.plan, plan, std::nullopt);
  }
  return record;
}

}  // namespace

Record RecordPlan(const trackbed::Scenario& scenario, trackbed::CarCache& cars) {
  trackbed::CheckScenario(scenario);
  const std::shared_ptr<const trackbed::CarModel> model = cars.Load(scenario);
  return RecordOfPlan(scenario, *model, trackbed::PlanRun(scenario, *model));
}

Record RecordRun(trackbed::Scenario scenario) {
  scenario.drive.state_period = scenario.drive.timestep;
  trackbed::CheckScenario(scenario);
  const trackbed::CarModel model = trackbed::LoadCar(scenario);
  const trackbed::RunResult result = trackbed::RunScenario(scenario, model);
  Record record = RecordOfPlan(scenario, model, result);
  const nlohmann::json metrics = trackbed::MetricsJson(result);
  record.passed = metrics.at("verdict").at("passed").get<bool>();
  for (const trackbed::RunLog& log : result.logs) {
    record.drives.push_back({.plant = log.plant,
                             .has_wheels = log.plant.starts_with("mujoco"),
                             .log = ToTable(log),
                             .steps = log.configurations,
                             .changes = Changes(log),
                             .overspeed_bound = OverspeedBound(metrics.at("verdict"), log.plant),
                             .kept = Kept(log),
                             .metrics = metrics.at("plants").at(log.plant)});
  }
  return record;
}

}  // namespace audit
