#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/control/controller_options.h"
#include "trackbed/control/speed_control_options.h"
#include "trackbed/planning/avoidance/avoidance_options.h"
#include "trackbed/planning/common/planner_options.h"
#include "trackbed/planning/common/speed_profile_options.h"
#include "trackbed/planning/replan/replan_options.h"
#include "trackbed/road_network/lane_route.h"
#include "trackbed/scenario/disturbances.h"
#include "trackbed/scenario/maneuver.h"
#include "trackbed/scenario/record.h"
#include "trackbed/scenario/track_options.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/world/world.h"

/// A scenario: one file, one reproducible experiment. SI units and radians throughout.
namespace trackbed {

struct Recording;

/// The default planner and controller of a scenario: fillet and preview.
PlannerOptions DefaultPlanner();
ControllerOptions DefaultController();

struct VehicleSpec {
  std::string model = "prius";    ///< a name under models/, or a path relative to the scenario file
  TyreLaw tyre = TyreLaw::kAuto;  ///< of the plant `mujoco`
  std::optional<double> steering_rate;  ///< at the road wheels, overrides the car's [rad/s]
};

/// The initial state of the car; defaults follow from the mission.
struct StartSpec {
  std::optional<double> x;    ///< [m]; default: the first waypoint, or 0
  std::optional<double> y;    ///< [m]
  std::optional<double> yaw;  ///< [rad]; default: the first heading, along the first leg, or 0
  /// [m/s]; default: that of the recording or of the speed over time, or the mission's speed.
  std::optional<double> speed;
  /// Bicycle angle of wheels and actuator [rad]; default: with prescribed steering the recorded
  /// angle, else 0.
  std::optional<double> steering;
};

struct MissionSpec {
  double speed = 0.0;           ///< [m/s]; 0: not set, for missions without a plan
  std::vector<Vec2> waypoints;  ///< [m]
  /// Heading of the car at each waypoint [rad]; empty: along the legs.
  std::vector<double> headings;
  std::vector<LanePlace> route;    ///< on the world's road network, instead of waypoints
  std::optional<double> duration;  ///< [s]; ends the run, for missions without a goal
  /// Speeds of the plan; none: ConstantAccelerationOptions.
  std::optional<SpeedProfileOptions> speed_profile;
  std::optional<TrackSpec> track;  ///< laps to drive, instead of waypoints
  StartSpec start;
};

/// The planner and its options.
struct PlanSpec {
  PlannerOptions global = DefaultPlanner();
  std::optional<AvoiderOptions> avoid;  ///< reroutes it around obstacles; none: no rerouting
  std::optional<ReplanOptions> replan;  ///< replans during the run; none: no replanning
  /// Handling of infeasible plans.
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
};

struct ControlSpec {
  ControllerOptions steering = DefaultController();
  SpeedControlOptions speed;
};

struct DriveSpec {
  std::vector<std::string> plants{"kinematic", "mujoco"};
  SteeringInput steering = SteeringInput::kActuator;
  double timestep = 0.002;           ///< of the physics [s]
  double control_period = 0.02;      ///< a whole number of timesteps [s]
  double state_period = 1.0 / 60.0;  ///< between configurations logged for the film [s]
  double time_limit = 600.0;         ///< simulated [s]
  /// Distance to the goal within which a car at rest has arrived, as a fraction of its length.
  double goal_tolerance = 0.1;
  /// Heading tolerance at the goal [rad], if the mission gives headings.
  double goal_heading_tolerance = 0.2;
};

/// A bound on any metric of a plant's entry in metrics.json.
struct MetricExpectation {
  std::string metric;  ///< its path: "maneuver.yaw_rate_overshoot", "turns[0].lateral_offset"
  std::optional<double> min;
  std::optional<double> max;
  std::optional<std::string> equals;  ///< "true", "arrived", "3"
};

/// A formula of temporal logic over the columns of the log (trackbed/requirement/formula.h).
struct RequirementExpectation {
  std::string name;  ///< of a-z, 0-9 and '_'
  std::string formula;
};

/// Bounds on one plant's metrics; checked if given.
struct PlantExpectation {
  std::optional<double> reach_goal;         ///< maximum distance to the goal at the end [m]
  std::optional<double> max_cross_track;    ///< [m]
  std::optional<double> rms_cross_track;    ///< [m]
  std::optional<double> max_heading_error;  ///< [rad]
  std::optional<double> min_clearance;      ///< minimum distance of the footprint to obstacles [m]
  std::optional<bool> collision;            ///< whether the car must hit an obstacle
  std::vector<MetricExpectation> metrics;   ///< bounds on other metrics
  std::vector<RequirementExpectation> requirements;
};

/// Bounds on the differences between two runs at equal station; checked if given.
struct DifferenceBounds {
  std::optional<double> position_max;  ///< [m]
  std::optional<double> heading_max;   ///< [rad]
  std::optional<double> yaw_rate_max;  ///< [rad/s]
  std::optional<double> steering_max;  ///< of the measured road-wheel angle [rad]

  [[nodiscard]] bool any() const {
    return position_max || heading_max || yaw_rate_max || steering_max;
  }
};

/// Bounds on the differences between two plants.
struct BetweenExpectation {
  std::vector<std::string> plants;  ///< two of them
  DifferenceBounds bounds;
};

struct Expectations {
  PlantExpectation all;  ///< for every plant
  std::vector<std::pair<std::string, PlantExpectation>> plants;
  std::vector<BetweenExpectation> between;
};

struct RenderSpec {
  std::string camera = "chase";
  int width = 1280;   ///< [pixels]
  int height = 720;   ///< [pixels]
  double fps = 30.0;  ///< [1/s]
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 0;
  VehicleSpec vehicle;
  MissionSpec mission;
  std::optional<RecordSpec> record;  ///< a recorded drive, if one is replayed
  World world;
  std::optional<PlanSpec> plan;             ///< none: the mission has no path
  std::optional<ManeuverOptions> maneuver;  ///< how the run is evaluated, if at all
  ControlSpec control;
  DriveSpec drive;
  Disturbances disturb;
  Expectations expect;
  RenderSpec render;

  // Not keys.
  std::filesystem::path folder;  ///< base of relative paths
  /// Folders from which a recording or the assets of a model may also be read. Without them, a
  /// recording must lie in or below `folder`, and a model's assets in or below the model's folder.
  std::vector<std::filesystem::path> asset_folders{};
};

/// `key=value`: replaces a key of the file before it is read; the value is YAML. An override of
/// drive.plants drops the file's expectations on other plants.
using Override = std::string;

/// Returns the paths that a plant's entry in metrics.json can have in a run of the scenario.
using MetricPaths = std::function<std::vector<std::string>(const Scenario& scenario)>;

/// Reads a scenario file strictly. InputError with **every** problem of the file: unknown key (with
/// the nearest known one), missing or repeated key, wrong type, NaN or infinity, out of range,
/// unknown name; each with file, line, column and dotted key. Problems of an override name the
/// override. `cameras` are the allowed values of render.camera; empty: not checked. `metrics` are
/// those of `expect.metrics`, called if there are no other problems; empty: not checked.
/// `asset_folders` become the scenario's.
Scenario ReadScenario(const std::filesystem::path& file,
                      const std::vector<Override>& overrides = {},
                      const std::vector<std::string>& cameras = {}, const MetricPaths& metrics = {},
                      const std::vector<std::filesystem::path>& asset_folders = {});

/// As ReadScenario, from text; `name` is the file's name in messages, `folder` the base of relative
/// paths.
Scenario ParseScenario(const std::string& yaml, const std::string& name,
                       const std::filesystem::path& folder,
                       const std::vector<Override>& overrides = {},
                       const std::vector<std::string>& cameras = {},
                       const MetricPaths& metrics = {},
                       const std::vector<std::filesystem::path>& asset_folders = {});

/// Reads only the `render` section of a scenario file, for videos of runs whose model may be
/// missing. InputError.
RenderSpec ReadRenderSpec(const std::filesystem::path& file);

/// Reads only the `vehicle` section of a scenario file. InputError.
VehicleSpec ReadVehicleSpec(const std::filesystem::path& file);

/// Reads only the `world` section of a scenario file, for films. InputError.
World ReadWorld(const std::filesystem::path& file);

/// Reads only the `expect` section of a scenario file, for reports. InputError.
Expectations ReadExpectations(const std::filesystem::path& file);

/// Checks combinations of keys. ReadScenario calls it; programs that fill the struct must call it
/// themselves. InputError.
void CheckScenario(const Scenario& scenario);

/// The scenario with every default filled in, as YAML that ReadScenario reads back to an equal
/// scenario from any folder. A model given by its path is written with its absolute path. Data from
/// other files must lie beside the YAML: a recording as `recording.csv` (RecordingCsv), a recorded
/// drive as `record.csv` (RecordCsv), a track as `track.csv` (TrackCsv), a map as `map.yaml` and
/// `map.pgm` (map_file.h), and a road network as `road_network.xodr`.
std::string ResolvedYaml(const Scenario& scenario);

/// The keys of a method's options with their values, on one line: "distance: 2.5, law: exact_arc".
std::string OptionDefaults(const PlannerOptions& options);
std::string OptionDefaults(const AvoiderOptions& options);
std::string OptionDefaults(const ControllerOptions& options);
std::string OptionDefaults(const ManeuverOptions& options);

/// Makes a scenario of a record. Its only plant is the record itself; overriding drive.plants
/// replays the record on those plants instead. It has the drive's name, those windows of 1, 2 and 5
/// s that fit in, the
/// record's period as control period if that is a whole number of timesteps, and a speed control
/// gain of 20/s. `model` as in VehicleSpec.
Scenario RecordScenario(std::shared_ptr<const RecordedDrive> drive, const std::string& model);

/// The replayed recording, if any; owned by the scenario.
const Recording* FindRecording(const Scenario& scenario);

/// The initial state of the car, with the mission's defaults filled in.
StartState InitialState(const Scenario& scenario);

/// End of the run [s]: the mission's duration, or without a plan the end of a recording over time.
/// None: the run ends at the goal.
std::optional<double> RunDuration(const Scenario& scenario);

/// The speed to keep [m/s]: the mission's, or the start speed if the mission gives none.
double MissionSpeed(const Scenario& scenario);

}  // namespace trackbed
