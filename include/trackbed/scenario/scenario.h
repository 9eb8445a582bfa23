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

/// A scenario: one file, one reproducible experiment. All quantities are in SI units and radians.
namespace trackbed {

struct Recording;

/// The default planner and controller of a scenario: fillet and preview.
PlannerOptions DefaultPlanner();
ControllerOptions DefaultController();

struct VehicleSpec {
  std::string model = "prius";    ///< Name under models/, or path relative to the scenario file.
  TyreLaw tyre = TyreLaw::kAuto;  ///< Tyre law of the plant `mujoco`.
  std::optional<double> steering_rate;  ///< Rate at the road wheels [rad/s]; overrides the car's.
};

/// The initial state of the car. Defaults follow from the mission.
struct StartSpec {
  std::optional<double> x;    ///< Coordinate x [m]; default: the first waypoint, or 0.
  std::optional<double> y;    ///< Coordinate y [m]; default: the first waypoint, or 0.
  std::optional<double> yaw;  ///< Yaw [rad]; default: the first heading, along the first leg, or 0.
  /// Speed [m/s]; default: that of the recording or of the speed over time, else the mission's
  /// speed.
  std::optional<double> speed;
  /// Steering angle of wheels and actuator in the bicycle model [rad]. Default: the recorded angle
  /// with prescribed steering, else 0.
  std::optional<double> steering;
};

struct MissionSpec {
  double speed = 0.0;           ///< Speed [m/s]; 0: not set, for missions without a plan.
  std::vector<Vec2> waypoints;  ///< Points of the route [m].
  /// Heading of the car at each waypoint [rad]; empty: along the legs.
  std::vector<double> headings;
  std::vector<LanePlace> route;    ///< Places on the world's road network, instead of waypoints.
  std::optional<double> duration;  ///< End of the run [s], for missions without a goal.
  /// Speeds of the plan; nullopt: ConstantAccelerationOptions.
  std::optional<SpeedProfileOptions> speed_profile;
  std::optional<TrackSpec> track;  ///< Laps to drive, instead of waypoints.
  StartSpec start;
};

/// The planner and its options.
struct PlanSpec {
  PlannerOptions global = DefaultPlanner();
  std::optional<AvoiderOptions> avoid;  ///< Local planner around obstacles; none: no rerouting.
  std::optional<ReplanOptions> replan;  ///< Replanning during the run; none: no replanning.
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
  double timestep = 0.002;           ///< Timestep of the physics [s].
  double control_period = 0.02;      ///< Control period, a whole number of timesteps [s].
  double state_period = 1.0 / 60.0;  ///< Time between configurations logged for the film [s].
  double time_limit = 600.0;         ///< Limit on the simulated time [s].
  /// Distance to the goal within which a car at rest has arrived, as a fraction of its length.
  double goal_tolerance = 0.1;
  /// Heading tolerance at the goal [rad], if the mission gives headings.
  double goal_heading_tolerance = 0.2;
};

/// A bound on any metric of a plant's entry in metrics.json.
struct MetricExpectation {
  std::string metric;  ///< Path in metrics.json: "cross_track.max".
  std::optional<double> min;
  std::optional<double> max;
  std::optional<std::string> equals;  ///< Required text: "true", "arrived", "3".
};

/// A formula of temporal logic over the columns of the log (trackbed/requirement/formula.h).
struct RequirementExpectation {
  std::string name;  ///< Name of a-z, 0-9 and '_'.
  std::string formula;
};

/// Bounds on the metrics of one plant. A bound is checked if it is given.
struct PlantExpectation {
  std::optional<double> reach_goal;         ///< Maximum distance to the goal at the end [m].
  std::optional<double> max_cross_track;    ///< Largest cross-track error [m].
  std::optional<double> rms_cross_track;    ///< Root mean square of the cross-track error [m].
  std::optional<double> max_heading_error;  ///< Largest heading error [rad].
  std::optional<double> min_clearance;      ///< Minimum distance of the footprint to obstacles [m].
  std::optional<bool> collision;            ///< Whether the car must hit an obstacle.
  std::vector<MetricExpectation> metrics;   ///< Bounds on other metrics.
  std::vector<RequirementExpectation> requirements;
};

/// Bounds on the differences between two runs at equal station. A bound is checked if it is given.
struct DifferenceBounds {
  std::optional<double> position_max;  ///< Largest difference in position [m].
  std::optional<double> heading_max;   ///< Largest difference in heading [rad].
  std::optional<double> yaw_rate_max;  ///< Largest difference in yaw rate [rad/s].
  std::optional<double> steering_max;  ///< Largest difference in road-wheel angle [rad].

  [[nodiscard]] bool any() const {
    return position_max || heading_max || yaw_rate_max || steering_max;
  }
};

/// Bounds on the differences between two plants.
struct BetweenExpectation {
  std::vector<std::string> plants;  ///< Names of the two plants.
  DifferenceBounds bounds;
};

struct Expectations {
  PlantExpectation all;  ///< Expectations on every plant.
  std::vector<std::pair<std::string, PlantExpectation>> plants;
  std::vector<BetweenExpectation> between;
};

struct RenderSpec {
  std::string camera = "chase";
  int width = 1280;   ///< Width [pixels].
  int height = 720;   ///< Height [pixels].
  double fps = 30.0;  ///< Frames per second [1/s].
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 0;
  VehicleSpec vehicle;
  MissionSpec mission;
  std::optional<RecordSpec> record;  ///< Recorded drive, if one is replayed.
  World world;
  std::optional<PlanSpec> plan;             ///< Planning; none: the mission has no path.
  std::optional<ManeuverOptions> maneuver;  ///< Evaluation of the run as a maneuver, if any.
  ControlSpec control;
  DriveSpec drive;
  Disturbances disturb;
  Expectations expect;
  RenderSpec render;

  // The members below are not keys.
  std::filesystem::path folder;  ///< Base of relative paths.
  /// Further folders that may contain recordings and the assets of models, in addition to `folder`
  /// for recordings and the model's folder for assets.
  std::vector<std::filesystem::path> asset_folders{};
};

/// An override `key=value` replaces a key of the file before the file is read. The value is YAML.
/// An override of drive.plants drops the file's expectations on other plants.
using Override = std::string;

/// Function that returns the paths that a plant's entry in metrics.json may have for the scenario.
using MetricPaths = std::function<std::vector<std::string>(const Scenario& scenario)>;

/// Reads a scenario file strictly. InputError lists **every** problem of the file, each with file,
/// line, column and dotted key: unknown key (with the most similar known key), missing or repeated
/// key, wrong type, NaN or infinity, value out of range, unknown name. Problems of an override name
/// the override. `cameras` are the allowed values of render.camera, `metrics` gives those of
/// `expect.metrics`. An empty argument is not checked. `asset_folders` become those of the
/// scenario.
Scenario ReadScenario(const std::filesystem::path& file,
                      const std::vector<Override>& overrides = {},
                      const std::vector<std::string>& cameras = {}, const MetricPaths& metrics = {},
                      const std::vector<std::filesystem::path>& asset_folders = {});

/// As ReadScenario, from text. Messages use `name` as the file's name; `folder` is the base of
/// relative paths.
Scenario ParseScenario(const std::string& yaml, const std::string& name,
                       const std::filesystem::path& folder,
                       const std::vector<Override>& overrides = {},
                       const std::vector<std::string>& cameras = {},
                       const MetricPaths& metrics = {},
                       const std::vector<std::filesystem::path>& asset_folders = {});

/// Reads only the `render` section of a scenario file, for videos of runs whose model may be
/// missing. Throws InputError.
RenderSpec ReadRenderSpec(const std::filesystem::path& file);

/// Reads only the `vehicle` section of a scenario file. Throws InputError.
VehicleSpec ReadVehicleSpec(const std::filesystem::path& file);

/// Reads only the `world` section of a scenario file, for films. Throws InputError.
World ReadWorld(const std::filesystem::path& file);

/// Reads only the `expect` section of a scenario file, for reports. Throws InputError.
Expectations ReadExpectations(const std::filesystem::path& file);

/// Checks combinations of keys; throws InputError. ReadScenario calls it. Programs that fill the
/// struct must call it themselves.
void CheckScenario(const Scenario& scenario);

/// Formats the scenario with every default filled in, as YAML. ReadScenario restores an equal
/// scenario from it, in any folder. A model given by its path is written with its absolute path.
/// Data from other files must lie in the folder of the YAML: a recording as `recording.csv`
/// (RecordingCsv), a recorded drive as `record.csv` (RecordCsv), a track as `track.csv` (TrackCsv),
/// a map as `map.yaml` and `map.pgm` (map_file.h), and a road network as `road_network.xodr`.
std::string ResolvedYaml(const Scenario& scenario);

/// The keys of a method's options with their values, on one line: "distance: 2.5, law: exact_arc".
std::string OptionDefaults(const PlannerOptions& options);
std::string OptionDefaults(const AvoiderOptions& options);
std::string OptionDefaults(const ControllerOptions& options);
std::string OptionDefaults(const ManeuverOptions& options);

/// Makes a scenario of a record. The only plant is the record; overriding drive.plants replays the
/// record on other plants instead. The scenario has the drive's name and a speed control gain of
/// 20/s. The record's windows are those of 1, 2 and 5 s that fit into the drive. The control period
/// is the record's period if that is a whole number of timesteps. `model` has the meaning of
/// VehicleSpec::model.
Scenario RecordScenario(std::shared_ptr<const RecordedDrive> drive, const std::string& model);

/// The recording that is replayed; null if there is none. The scenario owns the recording.
const Recording* FindRecording(const Scenario& scenario);

/// The initial state of the car, with the mission's defaults filled in.
StartState InitialState(const Scenario& scenario);

/// End of the run [s]: the mission's duration, or without a plan the end of a recording over time.
/// Nullopt: the run ends at the goal.
std::optional<double> RunDuration(const Scenario& scenario);

/// The speed to keep [m/s]: the mission's speed, or the start speed if the mission has none.
double MissionSpeed(const Scenario& scenario);

}  // namespace trackbed
