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

/// A scenario file describes one reproducible experiment. All quantities are in SI units and
/// radians.
namespace trackbed {

struct Recording;

/// The default planner and controller of a scenario: fillet and preview.
PlannerOptions DefaultPlanner();
ControllerOptions DefaultController();

struct VehicleSpec {
  std::string model = "prius";    ///< Name under models/, or path relative to the scenario file.
  TyreLaw tyre = TyreLaw::kAuto;  ///< Tyre law of the plant `mujoco`.
  /// Steering rate limit at the road wheels [rad/s]; overrides the limit of the model.
  std::optional<double> steering_rate;
};

/// The initial state of the car. Defaults follow from the mission.
struct StartSpec {
  std::optional<double> x;  ///< Coordinate x [m]; default: the first waypoint, or 0.
  std::optional<double> y;  ///< Coordinate y [m]; default: the first waypoint, or 0.
  /// Yaw [rad]; default: the mission's first heading, else the direction of the first leg, else 0.
  std::optional<double> yaw;
  /// Speed [m/s]; default: the initial speed of the recording, recorded drive, path file or speed
  /// signal, else the mission's speed.
  std::optional<double> speed;
  /// Steering angle of wheels and actuator in the bicycle model [rad]. Default: the initial angle
  /// of the recorded drive, or of a recording with prescribed steering, else the planner's neutral
  /// angle.
  std::optional<double> steering;
};

struct MissionSpec {
  double speed = 0.0;           ///< Speed [m/s]; 0 if a mission without a plan sets no speed.
  std::vector<Vec2> waypoints;  ///< Points of the route [m].
  /// Heading of the car at each waypoint [rad]; empty: along the legs.
  std::vector<double> headings;
  std::vector<LanePlace> route;    ///< Places on the road network, instead of waypoints.
  std::optional<double> duration;  ///< End of the run [s], for missions without a goal.
  /// Options of the plan's speed profile; default: ConstantAccelerationOptions.
  std::optional<SpeedProfileOptions> speed_profile;
  std::optional<TrackSpec> track;  ///< Laps to drive, instead of waypoints.
  StartSpec start;
};

/// The planner and its options.
struct PlanSpec {
  PlannerOptions global = DefaultPlanner();
  /// Local planner that avoids obstacles; none: no rerouting.
  std::optional<AvoiderOptions> avoid;
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
  double state_period = 1.0 / 60.0;  ///< Time between the states logged for films [s].
  double time_limit = 600.0;         ///< Limit on the simulated time [s].
  /// Distance to the goal within which a car at rest has arrived, as a fraction of the car's
  /// length.
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

/// Bounds on the metrics of one plant. Only the given bounds are checked.
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

/// Bounds on the differences between two runs at equal station. Only the given bounds are checked.
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
  std::filesystem::path folder;  ///< Folder to which file names in the scenario are relative.
  /// Further folders that may contain recordings and model assets. By default, recordings are in
  /// `folder`, and assets are in the model's folder.
  std::vector<std::filesystem::path> asset_folders{};
};

/// An override `key=value` replaces the value of a key in the file; the new value is YAML. If
/// drive.plants is overridden, the file's expectations on other plants are dropped.
using Override = std::string;

/// Function that returns the paths that a plant's entry in metrics.json may have for the scenario.
using MetricPaths = std::function<std::vector<std::string>(const Scenario& scenario)>;

/// Reads a scenario file strictly. InputError lists **every** problem of the file, each with file,
/// line, column and dotted key: unknown key (with the most similar known key), missing or repeated
/// key, wrong type, NaN or infinity, value out of range, unknown name. A problem of an override is
/// reported with the override's text. The allowed values of render.camera are `cameras`, and those
/// of `expect.metrics` are returned by `metrics`; if one of these arguments is empty, the key is
/// not checked. `asset_folders` becomes Scenario::asset_folders.
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

/// Checks combinations of keys; throws InputError. ReadScenario calls CheckScenario; programs that
/// fill a Scenario in code must call CheckScenario themselves.
void CheckScenario(const Scenario& scenario);

/// Formats the scenario with every default filled in, as YAML. ReadScenario restores an equal
/// scenario from this YAML, in any folder. A model given by its path is written with its absolute
/// path. Data from other files must lie in the folder of the YAML: a recording as `recording.csv`
/// (RecordingCsv), a recorded drive as `record.csv` (RecordCsv), a track as `track.csv` (TrackCsv),
/// a map as `map.yaml` and `map.pgm` (map_file.h), and a road network as `road_network.xodr`.
std::string ResolvedYaml(const Scenario& scenario);

/// Formats the keys of a method's options with their values, on one line: "distance: 2.5, law:
/// exact_arc".
std::string OptionDefaults(const PlannerOptions& options);
std::string OptionDefaults(const AvoiderOptions& options);
std::string OptionDefaults(const ControllerOptions& options);
std::string OptionDefaults(const ManeuverOptions& options);

/// Makes a scenario from a record. The only plant is the record; overriding drive.plants replays
/// the record on other plants instead. The scenario has the drive's name and a speed control gain
/// of 20/s. The prediction windows are 1, 2 and 5 s long, as far as they fit into the drive. The
/// control period is the record's period if that is a whole number of timesteps. `model` has the
/// meaning of VehicleSpec::model.
Scenario RecordScenario(std::shared_ptr<const RecordedDrive> drive, const std::string& model);

/// Returns the recording that the scenario replays; null if the scenario replays none. The scenario
/// owns the recording.
const Recording* FindRecording(const Scenario& scenario);

/// Returns the initial state of the car, with the defaults of StartSpec filled in.
StartState InitialState(const Scenario& scenario);

/// Returns the end of the run [s]: the mission's duration, or, without a plan, the end of a
/// recording over time. Nullopt if the run ends at the goal.
std::optional<double> RunDuration(const Scenario& scenario);

/// Returns the speed that the car must keep [m/s]: the mission's speed, or the start speed if the
/// mission has no speed.
double MissionSpeed(const Scenario& scenario);

}  // namespace trackbed
