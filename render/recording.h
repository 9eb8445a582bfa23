#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/car_box.h"
#include "render/palette.h"
#include "render/recorded_plans.h"
#include "render/scales.h"
#include "render/timed_table.h"
#include "trackbed/road_network/road_paint.h"
#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/plant.h"
#include "trackbed/track/track.h"
#include "trackbed/world/world.h"

namespace trackbed::render {

/// Position of another plant's car relative to the recorded car at the same time.
struct RelativePosition {
  std::string plant;
  double ahead = 0;  ///< Distance of the other car ahead, along the recorded car's heading [m].
  double left = 0;   ///< Distance of the other car to the left of the recorded car [m].
  /// Station of the other car minus the station of the recorded car [m]; nullopt if a log has no
  /// stations.
  std::optional<double> station{};
};

/// Values that the caption shows in one frame, in SI units and radians.
struct Readings {
  double time = 0;
  double speed = 0;
  double steering_command = 0;
  double steering = 0;
  std::optional<double> cross_track;  ///< Cross-track error [m]; nullopt if the run had no
                                      ///< planned path.
  /// Lateral acceleration [m/s^2]; nullopt if the log has no lateral acceleration.
  std::optional<double> lateral_acceleration;
  /// Largest fraction of the available grip that one of the tyres uses.
  std::optional<double> tyre_use;
  /// Names of the driver aids that intervene, such as "ABS ESC", or "-"; nullopt for a car with
  /// neither anti-lock brakes nor stability control.
  std::optional<std::string> aids;
  std::optional<double> hitch_angle;  ///< Hitch angle of the trailer [rad]; nullopt: no trailer.
  /// Position of the first ghost relative to the recorded car.
  std::optional<RelativePosition> apart;
  std::optional<Vec2> wind;  ///< Wind at the car [m/s]; nullopt if the run has no
                             ///< wind.
};

/// The recorded motion of one plant's car.
class PlantRecording {
 public:
  /// Reads `<plant>.state.csv` and `<plant>.csv` in `folder`. The constructor of PlantRecording
  /// throws InputError if the state file lacks the column of a joint of `model`. The argument
  /// `index` is the plant's index among the plants of the run, which determines the plant's color.
  PlantRecording(const std::filesystem::path& folder, const std::string& plant,
                 const mjModel& model, std::size_t index = 0);

  [[nodiscard]] const std::string& plant() const { return plant_; }
  /// Returns the color of the plant, which is the same in all films of a run.
  [[nodiscard]] Color color() const { return CarColor(index_); }
  [[nodiscard]] double begin() const { return state_.begin(); }
  [[nodiscard]] double end() const { return state_.end(); }
  [[nodiscard]] const std::vector<double>& times() const { return state_.times(); }

  /// Sets `data` to the car's state at `time` [s] and updates the poses of its bodies.
  void Pose(double time, const mjModel& model, mjData& data) const;

  /// Returns the position of the car's rear-axle center at `time`.
  [[nodiscard]] Point Position(double time) const;
  [[nodiscard]] const std::vector<double>& headings() const { return headings_; }
  [[nodiscard]] double Heading(double time) const;
  /// Returns the cosine of the angle between the car's z axis and the vertical: 1 if the car is
  /// upright, 0 if it lies on its side.
  [[nodiscard]] double Upright(double time) const;

  [[nodiscard]] Readings ReadingsAt(double time) const;
  [[nodiscard]] const TimedTable& log() const { return log_; }

 private:
  struct JointColumn {
    std::size_t column;
    int qpos;
  };

  std::string plant_;
  std::size_t index_;
  TimedTable state_;
  TimedTable log_;
  int free_joint_qpos_ = 0;
  // column indices of the position (x y z) and of the quaternion (qw qx qy qz) in the state file
  std::vector<std::size_t> pose_columns_;
  std::vector<JointColumn> joints_;
  std::vector<double> headings_;  // heading of the car's x axis in each row of state_, unwrapped
                                  // [rad]
  std::size_t speed_ = 0;
  std::size_t steering_command_ = 0;
  std::size_t steering_ = 0;
  std::optional<std::size_t> cross_track_;
  std::optional<std::size_t> lateral_acceleration_;
  std::optional<std::size_t> hitch_angle_;
};

/// The data of a recorded run, read from the run folder.
struct Recording {
  std::string name;  ///< Name of the run folder.
  std::string note;  ///< Note about the run, which the caption shows; may be empty.
  /// World of the run from `scenario.resolved.yaml`; if the file is missing, a flat world without
  /// wind.
  World world;
  MujocoModel model;
  std::vector<PlantRecording> plants;  ///< Recordings of the car (first) and of the ghosts.
  /// Path of the initial plan; empty if the run has no plan.
  std::vector<Point> plan;
  /// Plans that the car adopted during the run, in the order of time.
  std::vector<NewPlan> new_plans;
  /// Curvature of the initial and later plans, except plans whose files have no curvature.
  std::vector<CurvatureProfile> curvatures;
  std::optional<RoadLook> road;  ///< Road along the plan; nullopt on open ground.
  /// Track of the run, if any; the road lies between the two edges of the track.
  std::optional<Track> track;
  /// Pavement and road marks of the world's road network; empty if the world has no road network.
  RoadPaint roads;
  std::vector<Point> cones;  ///< Cones of the gates that the plan passes.
  /// The four corners of the area of each gate, between its cones.
  std::vector<std::vector<Point>> gates;
  TyreLaw tyre = TyreLaw::kAuto;  ///< Tyre law that the plant `mujoco` uses in this run.
  /// Maximum steering rate of the car [rad/s]; 0 if unknown.
  double steering_rate = 0;
  /// Time of the car's first contact with an obstacle [s]; nullopt if the car touched no obstacle.
  std::optional<double> contact_time;
  /// Time at which the car rolled over [s]; nullopt if the car did not roll over, or if
  /// metrics.json is missing.
  std::optional<double> roll_over_time;
  /// Scales of the charts and colors of this recording, possibly shared with other recordings.
  Scales scales;

  [[nodiscard]] double begin() const { return plants.front().begin(); }
  [[nodiscard]] double end() const;

  /// Returns the values that the caption shows for the car at `time` [s].
  [[nodiscard]] Readings ReadingsAt(double time) const;
  /// Returns the curvature of the plan that the car follows at `time`, at the car's position
  /// [rad/m]. Returns nullopt if the run has no plan, or after the end of the car's log.
  [[nodiscard]] std::optional<double> PlannedCurvature(double time) const;
  /// Whether a film of the recording shows a road.
  [[nodiscard]] bool has_road() const { return road || !roads.bands.empty(); }
  /// Returns the point on the ground at the x and y coordinates of `point`.
  [[nodiscard]] Point OnGround(const Point& point) const;
};

/// Returns the indices of the model's geoms `obstacle_i`, for each obstacle i of the world; -1 for
/// an obstacle without geom.
std::vector<int> ObstacleGeoms(const Recording& recording);

/// Reads the data that a film needs, for the named plants or, if no plant is named, for all plants.
/// The first of the named plants is shown as the car. Throws InputError if files are missing, for
/// example the files of a plant that `metrics.json` lists, or the path of `plan.json`.
Recording ReadRecording(const std::filesystem::path& folder,
                        const std::vector<std::string>& plants = {});

}  // namespace trackbed::render
