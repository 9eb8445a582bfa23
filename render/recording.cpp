#include "render/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/intervening_aids.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/road_look.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/path_files/drawn_lanes.h"
#include "trackbed/road_network/lane_paint.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/scenario/run_track.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/compile_scene.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/scene.h"
#include "trackbed/track/track_file.h"

// Reads the data of a run folder that a film needs: the model, the states and log of each plant,
// the scenario's world, plans, gates and road. Between recorded rows, positions and joint angles
// are interpolated linearly, and quaternions linearly with normalization (nlerp). One plant,
// preferably a MuJoCo plant, is shown as the car; the other plants are ghosts.
namespace trackbed::render {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void RejectRecording(const fs::path& file, std::string key, std::string message) {
  throw InputError(
      Problem{.file = file.string(), .key = std::move(key), .message = std::move(message)});
}

MujocoModel LoadModel(const fs::path& file) {
  return CompileScene(ComposeScene(run_folder::RequireFile(file), {}), file.string(), Looks::kKept);
}

/// Returns the names of the plants that have a state file in the folder.
std::vector<std::string> PlantsWithStates(const fs::path& folder) {
  std::vector<std::string> plants;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (auto plant = run_folder::PlantOfStateCsv(entry.path().filename().string())) {
      plants.push_back(*std::move(plant));
    }
  }
  if (plants.empty()) {
    RejectRecording(folder, "",
                    "no <plant>.state.csv in the folder: not a run, or one that recorded nothing");
  }
  return plants;
}

/// Throws InputError if `metrics.json` contains a plant that is not among `plants`.
void CheckAllAreThere(const fs::path& folder, const std::vector<std::string>& plants) {
  const fs::path metrics = folder / run_folder::kMetricsJson;
  std::error_code ignored;
  if (!fs::exists(metrics, ignored)) {
    return;
  }
  const JsonValue plants_of_run = ReadJson(metrics).At("plants");
  for (const auto& [plant, entry] : plants_of_run.Members()) {
    if (std::find(plants.begin(), plants.end(), plant) == plants.end()) {
      RejectRecording(
          folder / run_folder::StateCsv(plant), "",
          fmt::format("missing from the run folder, whose metrics.json lists a run on {}", plant));
    }
  }
}

/// Returns the names of the plants of the run, beginning with the plant that is shown as the car.
std::vector<std::string> FindPlants(const fs::path& folder) {
  std::vector<std::string> plants = PlantsWithStates(folder);
  CheckAllAreThere(folder, plants);
  std::sort(plants.begin(), plants.end());
  std::stable_partition(plants.begin(), plants.end(),
                        [](const std::string& plant) { return plant.starts_with("mujoco"); });
  return plants;
}

/// Returns the names of the plants to film: `selected` or, if `selected` is empty, all plants.
std::vector<std::string> SelectPlants(const fs::path& folder, std::vector<std::string> available,
                                      const std::vector<std::string>& selected) {
  for (const std::string& plant : selected) {
    if (std::find(available.begin(), available.end(), plant) == available.end()) {
      RejectRecording(folder, "plants", "unknown plant " + UnknownName(plant, available));
    }
    if (std::count(selected.begin(), selected.end(), plant) > 1) {
      RejectRecording(folder, "plants", fmt::format("'{}' is listed twice", plant));
    }
  }
  return selected.empty() ? std::move(available) : selected;
}

/// Reads the gates and their cones from a plan.json, and adds them to the recording.
void AddGates(const fs::path& file, Recording& recording) {
  for (const std::vector<Point>& cones : ReadGates(file)) {
    for (const Point& cone : cones) {
      recording.cones.push_back(recording.OnGround(cone));
    }
    // The cones of a gate are listed in pairs, left and right of the lane, from entry to exit. The
    // outline of a gate connects the first and the last pair of its cones.
    if (cones.size() >= 4) {
      const std::size_t last = cones.size() - 1;
      std::vector<Point> corners;
      for (const std::size_t i : {std::size_t{0}, std::size_t{1}, last, last - 1}) {
        corners.push_back(recording.OnGround(cones[i]));
      }
      recording.gates.push_back(std::move(corners));
    }
  }
}

/// Returns the name of the planner from a plan.json; empty if the file is missing.
std::string PlannerOf(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    return "";
  }
  const std::optional<JsonValue> method = ReadJson(file).Find("method");
  return method ? method->Text() : "";
}

/// Returns the station of the second log's car minus that of the first log's car [m]; nullopt if a
/// log has no stations.
std::optional<double> StationBetween(const TimedTable& first, const TimedTable& second,
                                     double time) {
  const std::optional<std::size_t> own = first.Find("s_m");
  const std::optional<std::size_t> other = second.Find("s_m");
  if (!own || !other) {
    return std::nullopt;
  }
  return second.Value(second.At(time), *other) - first.Value(first.At(time), *own);
}

/// Returns the car's maximum steering rate at the road wheels [rad/s]; 0 if the model defines no
/// steering rate.
double SteeringRate(const mjModel& model, const VehicleSpec& vehicle) {
  const auto number = [&](const char* name) {
    const int id = mj_name2id(&model, mjOBJ_NUMERIC, name);
    return id < 0 ? 0.0 : model.numeric_data[model.numeric_adr[id]];
  };
  const double ratio = number("steering_ratio");
  return vehicle.steering_rate.value_or(ratio > 0.0 ? number("steering_wheel_rate") / ratio : 0.0);
}

/// Reads the times of first contact and roll-over from metrics.json. If metrics.json is missing,
/// the time of contact is read from the log, and the time of a roll-over is unknown.
void ReadMishaps(const fs::path& folder, Recording& recording) {
  const PlantRecording& car = recording.plants.front();
  const fs::path metrics = folder / run_folder::kMetricsJson;
  if (std::error_code ignored; fs::exists(metrics, ignored)) {
    const std::optional<JsonValue> own = ReadJson(metrics).At("plants").Find(car.plant());
    const std::optional<JsonValue> collision = own ? own->Find("collision") : std::nullopt;
    if (collision && collision->Flag()) {
      recording.contact_time = own->At("clearance_min_t").Number();
    }
    const std::optional<JsonValue> status = own ? own->Find("status") : std::nullopt;
    if (status && status->Text() == ToString(DriveStatus::kRolledOver)) {
      recording.roll_over_time = own->At("status_t").Number();
    }
    return;
  }
  if (const std::optional<std::size_t> clearance = car.log().Find("clearance_m")) {
    for (std::size_t row = 0; row < car.log().times().size() && !recording.contact_time; ++row) {
      if (car.log().table().at(row, *clearance) <= 0.0) {
        recording.contact_time = car.log().times()[row];
      }
    }
  }
}

/// Returns a text that lists the car's parameters that the scenario changed.
std::string VehicleNote(const VehicleSpec& vehicle) {
  return vehicle.steering_rate
             ? fmt::format("steering rate set to {:.2f} rad/s", *vehicle.steering_rate)
             : "";
}

}  // namespace

PlantRecording::PlantRecording(const fs::path& folder, const std::string& plant,
                               const mjModel& model, std::size_t index)
    : plant_(plant),
      index_(index),
      state_(folder / run_folder::StateCsv(plant)),
      log_(folder / run_folder::LogCsv(plant)),
      speed_(log_.Require("speed_mps")),
      steering_command_(log_.Require("steering_command_rad")),
      steering_(log_.Require("steering_rad")),
      cross_track_(log_.Find("cross_track_m")),
      lateral_acceleration_(log_.Find("lateral_acceleration_mps2")),
      hitch_angle_(log_.Find("hitch_angle_rad")) {
  for (const char* column : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"}) {
    pose_columns_.push_back(state_.Require(column));
  }
  const int chassis = mj_name2id(&model, mjOBJ_JOINT, "chassis");
  if (chassis < 0 || model.jnt_type[chassis] != mjJNT_FREE) {
    RejectRecording(folder / run_folder::kModelXml, "", "no free joint named 'chassis'");
  }
  free_joint_qpos_ = model.jnt_qposadr[chassis];
  for (int joint = 0; joint < model.njnt; ++joint) {
    const int type = model.jnt_type[joint];
    if (type == mjJNT_HINGE || type == mjJNT_SLIDE) {
      const char* name = mj_id2name(&model, mjOBJ_JOINT, joint);
      const std::string column =
          std::string(name == nullptr ? "" : name) + (type == mjJNT_SLIDE ? "_m" : "_rad");
      joints_.push_back({state_.Require(column), model.jnt_qposadr[joint]});
    }
  }
  const Table& rows = state_.table();
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const auto q = [&](std::size_t i) { return rows.at(row, pose_columns_[3 + i]); };
    const double heading =
        std::atan2(2.0 * (q(1) * q(2) + q(0) * q(3)), 1.0 - 2.0 * (q(2) * q(2) + q(3) * q(3)));
    const double before = headings_.empty() ? heading : headings_.back();
    headings_.push_back(before + AngleDifference(heading, before));
  }
}

void PlantRecording::Pose(double time, const mjModel& model, mjData& data) const {
  const TimedTable::Place place = state_.At(time);
  mjtNum* pose = data.qpos + free_joint_qpos_;
  for (std::size_t i = 0; i < 3; ++i) {
    pose[i] = state_.Value(place, pose_columns_[i]);
  }
  // The quaternions q and -q describe the same rotation, so the sign with the shorter arc is
  // chosen.
  double dot = 0.0;
  for (std::size_t i = 3; i < 7; ++i) {
    dot += state_.table().at(place.row, pose_columns_[i]) *
           state_.table().at(place.next, pose_columns_[i]);
  }
  for (std::size_t i = 3; i < 7; ++i) {
    pose[i] = (1.0 - place.part) * state_.table().at(place.row, pose_columns_[i]) +
              std::copysign(place.part, dot) * state_.table().at(place.next, pose_columns_[i]);
  }
  mju_normalize4(pose + 3);
  for (const JointColumn& joint : joints_) {
    data.qpos[joint.qpos] = state_.Value(place, joint.column);
  }
  mj_kinematics(&model, &data);
  mj_comPos(&model, &data);
  mj_camlight(&model, &data);
}

Point PlantRecording::Position(double time) const {
  const TimedTable::Place place = state_.At(time);
  return {state_.Value(place, pose_columns_[0]), state_.Value(place, pose_columns_[1])};
}

double PlantRecording::Heading(double time) const {
  const TimedTable::Place place = state_.At(time);
  return headings_[place.row] + place.part * (headings_[place.next] - headings_[place.row]);
}

double PlantRecording::Upright(double time) const {
  const TimedTable::Place place = state_.At(time);
  const auto q = [&](std::size_t i) { return state_.Value(place, pose_columns_[3 + i]); };
  const double squared = q(0) * q(0) + q(1) * q(1) + q(2) * q(2) + q(3) * q(3);
  return 1.0 - 2.0 * (q(1) * q(1) + q(2) * q(2)) / squared;
}

Readings PlantRecording::ReadingsAt(double time) const {
  const TimedTable::Place place = log_.At(time);
  Readings readings;
  readings.time = time;
  readings.speed = log_.Value(place, speed_);
  readings.steering_command = log_.Value(place, steering_command_);
  readings.steering = log_.Value(place, steering_);
  if (cross_track_) {
    readings.cross_track = log_.Value(place, *cross_track_);
  }
  if (lateral_acceleration_) {
    readings.lateral_acceleration = log_.Value(place, *lateral_acceleration_);
  }
  readings.aids = InterveningAids(log_, place);
  if (hitch_angle_) {
    readings.hitch_angle = log_.Value(place, *hitch_angle_);
  }
  return readings;
}

double Recording::end() const {
  double last = plants.front().end();
  for (const PlantRecording& plant : plants) {
    last = std::max(last, plant.end());
  }
  return last;
}

Readings Recording::ReadingsAt(double time) const {
  Readings readings = plants.front().ReadingsAt(time);
  if (plants.size() > 1 && time <= std::min(plants[0].end(), plants[1].end())) {
    const Point car = plants[0].Position(time);
    const Point other = plants[1].Position(time);
    const double heading = plants[0].Heading(time);
    const double dx = other.x - car.x;
    const double dy = other.y - car.y;
    readings.apart = {plants[1].plant(), dx * std::cos(heading) + dy * std::sin(heading),
                      -dx * std::sin(heading) + dy * std::cos(heading),
                      StationBetween(plants[0].log(), plants[1].log(), time)};
  }
  if (!IsCalm(world.wind)) {
    const Point car = plants.front().Position(time);
    readings.wind = WindAt(world, {car.x, car.y}, time);
  }
  return readings;
}

std::optional<double> Recording::PlannedCurvature(double time) const {
  const TimedTable& log = plants.front().log();
  const CurvatureProfile* held = nullptr;
  for (const CurvatureProfile& profile : curvatures) {
    if (held == nullptr || profile.from <= time) {
      held = &profile;
    }
  }
  const std::optional<std::size_t> station = log.Find("s_m");
  if (held == nullptr || !station || time > log.end()) {
    return std::nullopt;
  }
  const double s = log.Value(log.At(time), *station) - held->station;
  const auto after = std::upper_bound(held->s.begin(), held->s.end(), s);
  const auto next = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      after - held->s.begin(), 1, std::max<std::ptrdiff_t>(1, std::ssize(held->s) - 1)));
  if (next >= held->s.size()) {
    return held->curvature.front();
  }
  const double part =
      std::clamp((s - held->s[next - 1]) / (held->s[next] - held->s[next - 1]), 0.0, 1.0);
  return held->curvature[next - 1] + part * (held->curvature[next] - held->curvature[next - 1]);
}

Point Recording::OnGround(const Point& point) const {
  return {point.x, point.y, GroundHeight(world, {point.x, point.y})};
}

std::vector<int> ObstacleGeoms(const Recording& recording) {
  std::vector<int> geoms;
  for (std::size_t i = 0; i < recording.world.obstacles.size(); ++i) {
    geoms.push_back(
        mj_name2id(recording.model.get(), mjOBJ_GEOM, fmt::format("obstacle_{}", i).c_str()));
  }
  return geoms;
}

Recording ReadRecording(const fs::path& folder, const std::vector<std::string>& selected) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) {
    RejectRecording(folder, "", "no such folder");
  }
  if (!fs::is_directory(folder, ignored)) {
    RejectRecording(folder, "", "not a folder, but a run is one");
  }
  const std::vector<std::string> all = FindPlants(folder);
  Recording recording;
  recording.name = fs::weakly_canonical(folder).filename().string();
  recording.model = LoadModel(folder / run_folder::kModelXml);
  const std::vector<std::string> plants = SelectPlants(folder, all, selected);
  for (const std::string& plant : plants) {
    const auto index = std::find(all.begin(), all.end(), plant) - all.begin();
    recording.plants.emplace_back(folder, plant, *recording.model, static_cast<std::size_t>(index));
  }
  if (const fs::path scenario = folder / run_folder::kScenarioYaml; fs::exists(scenario, ignored)) {
    for (const char* map : {kMapYaml, kMapPgm}) {
      if (fs::exists(folder / map, ignored)) {
        run_folder::RequireFile(folder / map);
      }
    }
    recording.world = ReadWorld(run_folder::RequireFile(scenario));
    const VehicleSpec vehicle = ReadVehicleSpec(scenario);
    recording.note = VehicleNote(vehicle);
    recording.tyre = vehicle.tyre;
    recording.steering_rate = SteeringRate(*recording.model, vehicle);
  } else {
    recording.steering_rate = SteeringRate(*recording.model, {});
  }
  ReadMishaps(folder, recording);
  AddGates(folder / run_folder::kPlanJson, recording);
  const fs::path plan = folder / run_folder::kPlanCsv;
  if (fs::exists(folder / run_folder::kPlanJson, ignored) && !fs::exists(plan, ignored)) {
    RejectRecording(plan, "", "missing from the run folder, which has plan.json");
  }
  const fs::path new_plans = folder / run_folder::NewPlansCsv(plants.front());
  recording.plan = ReadPlan(plan);
  if (!recording.plan.empty()) {
    recording.road = RoadToDraw(recording.world, PlannerOf(folder / run_folder::kPlanJson));
  }
  if (const fs::path track = folder / kTrackCsv; fs::exists(track, ignored)) {
    recording.track = ReadRunTrack(run_folder::RequireFile(track),
                                   run_folder::RequireFile(folder / run_folder::kScenarioYaml));
  }
  if (recording.world.road_network) {
    // spacing of points along lines [m]; a polyline with this spacing deviates by 1 cm from an arc
    // with a radius of 12 m
    constexpr double kSpacing = 1.0;
    const fs::path file = run_folder::RequireFile(folder / kRoadNetworkXodr);
    const auto& read = recording.world.road_network->data;
    recording.roads = PaintRoads(read ? read->network : ReadOpenDrive(file), kSpacing);
  }
  if (const fs::path lanes = folder / kLanesCsv; fs::exists(lanes, ignored)) {
    recording.roads = PaintLanes(ReadLanesCsv(run_folder::RequireFile(lanes)));
    recording.road.reset();
  }
  recording.new_plans = ReadNewPlans(new_plans);
  recording.curvatures = ReadCurvatures(plan, recording.begin());
  // Stations in the log continue to increase when the car adopts a new plan, but stations in each
  // plan begin at 0.
  const TimedTable& log = recording.plants.front().log();
  const std::optional<std::size_t> station = log.Find("s_m");
  for (CurvatureProfile& profile : ReadCurvatures(new_plans, recording.begin())) {
    profile.station = station ? log.Value(log.At(profile.from), *station) : 0.0;
    recording.curvatures.push_back(std::move(profile));
  }
  recording.scales = ComputeScales(recording);
  return recording;
}

}  // namespace trackbed::render
