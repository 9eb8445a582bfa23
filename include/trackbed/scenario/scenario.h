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
#include "trackbed/sim/driver_aids.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/trailer.h"
#include "trackbed/world/world.h"

/// A scenario file describes one reproducible experiment. All quantities are in SI units and
/// radians.
namespace trackbed {

struct Recording;

/// Return the default planner (fillet) and the default controller (preview) of a scenario.
PlannerOptions DefaultPlanner();
ControllerOptions DefaultController();

struct VehicleSpec {
  /// Name of a model in models/, or path of a model file relative to the scenario file.
  std::string model = "prius";
  TyreLaw tyre = TyreLaw::kAuto;  ///< Tyre model of the plant `mujoco`.
  /// Tyre property file (*.tir) of the tyres of both axles, relative to the scenario file; replaces
  /// the tyre coefficients in the car model.
  std::optional<std::string> tyre_file{};
  std::optional<std::string> tyre_file_rear{};  ///< File of the rear tyres; default: tyre_file.
  /// Maximum steering rate of the road wheels [rad/s]; overrides the limit in the car model.
  std::optional<double> steering_rate;
  std::optional<AidOptions> aids{};         ///< Driver aids of the plant `mujoco`; nullopt: none.
  std::optional<TrailerOptions> trailer{};  ///< Trailer behind the car; nullopt: none.
};

/// The initial state of the car. Start values that are not set are derived from the mission.
struct StartSpec {
  std::optional<double> x;  ///< Initial x of the car [m]; default: x of the first waypoint, or 0.
  std::optional<double> y;  ///< Initial y of the car [m]; default: y of the first waypoint, or 0.
  /// Initial yaw of the car [rad]; default: the mission's first heading, else the direction from
  /// the first to the second waypoint, else 0.
  std::optional<double> yaw;
  /// Initial speed of the car [m/s]; default: the initial speed of the recording, recorded drive,
  /// path file or speed signal, else the mission's speed.
  std::optional<double> speed;
  /// Initial steering angle of the wheels and the actuator, as an angle of the bicycle model [rad].
  /// The default steering angle is the initial angle of the recorded drive, or of a recording with
  /// prescribed steering; otherwise the planner's neutral angle.
  std::optional<double> steering;
  std::optional<double> hitch_angle{};  ///< Yaw of trailer minus yaw of car [rad]; default: 0.
};

struct MissionSpec {
  double speed = 0.0;  ///< Speed of the mission [m/s]; 0 if a mission without a plan sets no speed.
  std::vector<Vec2> waypoints;  ///< Points through which the route leads [m].
  /// Heading of the car at each waypoint [rad]; if empty, the headings follow from the directions
  /// between the waypoints.
  std::vector<double> headings;
  /// Places on the road network that the route visits, instead of waypoints.
  std::vector<LanePlace> route;
  std::optional<double> duration;  ///< Duration of the run [s], for missions without a goal.
  std::optional<SpeedProfileOptions> speed_profile;  ///< Default: ConstantAccelerationOptions.
  std::optional<TrackSpec> track;  ///< Track and number of laps to drive, instead of waypoints.
  StartSpec start;
};

/// The global planner, the local planner and replanning, with their options.
struct PlanSpec {
  PlannerOptions global = DefaultPlanner();
  /// Local planner that reroutes around obstacles; nullopt: no rerouting.
  std::optional<AvoiderOptions> avoid;
  /// Periodic replanning during the run; nullopt: no replanning.
  std::optional<ReplanOptions> replan;
  /// Decides whether a plan that the car cannot follow is slowed down, refused or driven.
  InfeasiblePolicy infeasible = InfeasiblePolicy::kSlowDown;
  /// Largest allowed distance of the planned path from each waypoint [m], >= 0; nullopt: the car's
  /// length for planners with PlannerEntry::bounds_waypoint_miss, no bound for other planners.
  std::optional<double> max_waypoint_miss{};
};

struct ControlSpec {
  ControllerOptions steering = DefaultController();
  SpeedControlOptions speed;
  /// The model of the car's steering actuator that path-following controllers use.
  ActuatorKnowledge actuator = ActuatorKnowledge::kModel;
};

struct DriveSpec {
  std::vector<std::string> plants{"kinematic", "mujoco"};
  SteeringInput steering = SteeringInput::kActuator;
  double timestep = 0.002;  ///< Timestep of the physics simulation [s].
  /// Time between two updates of the controller, a whole number of timesteps [s].
  double control_period = 0.02;
  double state_period = 1.0 / 60.0;  ///< Time between two states that are logged for videos [s].
  double time_limit = 600.0;         ///< Simulated time after which the run is ended [s].
  /// Maximum distance from a car at rest to the goal at which the car counts as arrived, as a
  /// fraction of the car's length.
  double goal_tolerance = 0.1;
  /// Maximum heading error at the goal [rad]; only used if the mission sets headings.
  double goal_heading_tolerance = 0.2;
};

/// An expectation on any metric in a plant's entry of metrics.json.
struct MetricExpectation {
  std::string metric;  ///< Path of the metric in metrics.json, such as "cross_track.max".
  std::optional<double> min;
  std::optional<double> max;
  std::optional<std::string> equals;  ///< Required value as text, such as "true", "arrived" or "3".
};

/// A requirement on the log of a run, as a formula of temporal logic
/// (trackbed/requirement/formula.h).
struct RequirementExpectation {
  std::string name;  ///< Name of the requirement; only the characters a-z, 0-9 and '_' are allowed.
  std::string formula;
};

/// Expectations on the metrics of a plant. Only expectations that are set are checked.
struct PlantExpectation {
  /// Maximum distance to the goal at the end of the run [m].
  std::optional<double> reach_goal;
  std::optional<double> max_cross_track;  ///< Maximum allowed cross-track error [m].
  /// Maximum allowed root mean square of the cross-track error [m].
  std::optional<double> rms_cross_track;
  std::optional<double> max_heading_error;  ///< Maximum allowed heading error [rad].
  std::optional<double> max_hitch_angle{};  ///< Maximum allowed magnitude of the hitch angle [rad].
  /// Minimum allowed distance from the car's footprint to obstacles [m].
  std::optional<double> min_clearance;
  /// True if the car must hit an obstacle, false if the car must not hit any obstacle.
  std::optional<bool> collision;
  std::vector<MetricExpectation> metrics;  ///< Expectations on metrics that have no own key.
  std::vector<RequirementExpectation> requirements;
};

/// Bounds on the differences between two runs at equal stations. Only bounds that are set are
/// checked.
struct DifferenceBounds {
  std::optional<double> position_max;  ///< Maximum allowed difference in position [m].
  std::optional<double> heading_max;   ///< Maximum allowed difference in heading [rad].
  std::optional<double> yaw_rate_max;  ///< Maximum allowed difference in yaw rate [rad/s].
  /// Maximum allowed difference in the steering angle of the road wheels [rad].
  std::optional<double> steering_max;

  [[nodiscard]] bool any() const {
    return position_max || heading_max || yaw_rate_max || steering_max;
  }
};

/// Expectation on the differences between two plants.
struct BetweenExpectation {
  std::vector<std::string> plants;  ///< Names of the two plants to compare.
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
  double fps = 30.0;  ///< Number of frames per second of simulated time [1/s].
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 0;
  /// Local origin, in the coordinates of the scenario file [m]; nullopt: (0, 0). ReadScenario makes
  /// the coordinates in all other members relative to the local origin.
  std::optional<Vec2> origin{};
  VehicleSpec vehicle;
  MissionSpec mission;
  std::optional<RecordSpec> record;  ///< Recorded drive to replay; nullopt: no replay.
  World world;
  /// Planners and their options; nullopt if the mission has no path.
  std::optional<PlanSpec> plan;
  /// Standard maneuver according to which the run is evaluated; nullopt: the run is not evaluated
  /// as a maneuver.
  std::optional<ManeuverOptions> maneuver;
  ControlSpec control;
  DriveSpec drive;
  Disturbances disturb;
  Expectations expect;
  RenderSpec render;

  // The following members of Scenario are not keys of the scenario file.
  /// Folder of the scenario; file names in the scenario are relative to this folder.
  std::filesystem::path folder;
  /// Further folders from which recordings and assets of the model may be read, besides `folder`
  /// for recordings and the folder of the model for assets.
  std::vector<std::filesystem::path> asset_folders{};
};

/// An override `key=value` replaces the value of a key in the file; the new value is YAML. If
/// drive.plants is overridden, expectations on plants that are not in the new list are removed.
using Override = std::string;

/// Function that returns the paths of all metrics that a plant's entry in metrics.json may contain
/// for the scenario.
using MetricPaths = std::function<std::vector<std::string>(const Scenario& scenario)>;

/// Reads a scenario file and rejects any invalid key. Throws InputError, which lists **every**
/// problem of the file, each with file, line, column and dotted key: unknown key (with the most
/// similar known key), missing or repeated key, wrong type, NaN or infinity, value out of range,
/// unknown name. For a problem of an override, the InputError states the text of the override. The
/// function `metrics` returns the names that are allowed in `expect.metrics`. If `metrics` is
/// empty, ReadScenario does not check metric names; LoadScenario (analysis/run.h) checks them.
/// `asset_folders` becomes Scenario::asset_folders.
///
/// If a coordinate of a place exceeds 1e5 m, as in UTM, all places are moved to one local origin
/// (Scenario::origin). The local origin is the middle of the places, rounded to 1000 m, or the key
/// `origin`. Places are the positions in keys and files, and the start. Throws InputError if a
/// place is more than 1e5 m from the origin, because the inputs then differ in coordinate system.
/// The <offset> in the header of a road network is added to the roads' coordinates if only the
/// shifted roads are near the other places.
Scenario ReadScenario(const std::filesystem::path& file,
                      const std::vector<Override>& overrides = {}, const MetricPaths& metrics = {},
                      const std::vector<std::filesystem::path>& asset_folders = {});

/// Returns the scenario's local origin [m], in the coordinates of its file; (0, 0) if there is no
/// local origin. A coordinate in the file equals the coordinate in the Scenario plus the origin.
Vec2 OriginOf(const Scenario& scenario);

/// Reads a scenario like ReadScenario, but from the text `yaml`. Error messages use `name` as the
/// name of the file. Relative paths in the scenario are relative to `folder`.
Scenario ParseScenario(const std::string& yaml, const std::string& name,
                       const std::filesystem::path& folder,
                       const std::vector<Override>& overrides = {}, const MetricPaths& metrics = {},
                       const std::vector<std::filesystem::path>& asset_folders = {});

/// Reads only the `render` section of a scenario file, for videos of runs whose model may be
/// missing. Throws InputError.
RenderSpec ReadRenderSpec(const std::filesystem::path& file);

/// Reads only the `vehicle` section of a scenario file. Throws InputError.
VehicleSpec ReadVehicleSpec(const std::filesystem::path& file);

/// Reads only the `world` section of a scenario file, for videos. Throws InputError.
World ReadWorld(const std::filesystem::path& file);

/// Reads only the `expect` section of a scenario file, for reports. Throws InputError.
Expectations ReadExpectations(const std::filesystem::path& file);

/// Checks a scenario that a program fills in code as strictly as ReadScenario checks a file. Throws
/// InputError, which lists the problems with their dotted keys. RunScenario calls CheckScenario;
/// programs that call PlanScenario or SimulateScenario must call CheckScenario themselves.
void CheckScenario(const Scenario& scenario);

/// Formats the scenario as YAML, including all default values. ReadScenario reads an equal scenario
/// from this YAML, in any folder. The YAML has the coordinates of the scenario's own file, and
/// states the local origin in the key `origin`. A model that is given by a path is written with its
/// absolute path. The caller must write the data of a recording, a drive, a track or a map to the
/// folder of the YAML file. A recording is written as `recording.csv` (RecordingCsv), a recorded
/// drive as `record.csv` (RecordCsv), and a track as `track.csv` (TrackCsv). A map is written as
/// `map.yaml` and `map.pgm` (map_file.h), and a road network as `road_network.xodr`.
std::string ResolvedYaml(const Scenario& scenario);

/// Formats the keys and values of a method's options on one line, such as "distance: 2.5, law:
/// exact_arc".
std::string OptionDefaults(const PlannerOptions& options);
std::string OptionDefaults(const AvoiderOptions& options);
std::string OptionDefaults(const ControllerOptions& options);
std::string OptionDefaults(const ManeuverOptions& options);

/// Returns the recording that the scenario replays, or null if the scenario replays no recording.
/// The scenario owns the returned recording.
const Recording* FindRecording(const Scenario& scenario);

/// Returns the initial state of the car, with default values for members of StartSpec that are not
/// set.
StartState InitialState(const Scenario& scenario);

/// Returns the duration of the run [s]: the mission's duration, or, if there is no plan, the
/// duration of the replayed recording over time. Returns nullopt if the run ends at the goal.
std::optional<double> RunDuration(const Scenario& scenario);

/// Returns the speed that the car must keep [m/s]: the mission's speed, or the start speed if the
/// mission has no speed.
double MissionSpeed(const Scenario& scenario);

}  // namespace trackbed
