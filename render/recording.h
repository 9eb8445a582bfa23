#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

/// Position of another plant's car relative to the recorded car, at the same time.
struct RelativePosition {
  std::string plant;
  double ahead = 0;  ///< Distance along the car's heading [m].
  double left = 0;   ///< Distance to the left of the car [m].
  /// Station of the other car along the path, minus the station of the recorded car [m]; nullopt if
  /// a log has no stations.
  std::optional<double> station{};
};

/// Bounding box of a car, upright on the ground, in the vehicle frame [m].
struct CarBox {
  double middle = 1.3;  ///< x coordinate of the box's center, measured from the rear axle
  double half_length = 2.2;
  double half_width = 0.9;
  double height = 1.5;

  /// Returns the size of the car relative to a full-size car, by which cameras, marks and shadows
  /// are scaled. Cars that are 4 m long or longer have size 1.
  [[nodiscard]] double scale() const { return std::min(1.0, half_length / 2.0); }
};

/// Returns the box of the model's site `footprint`; the default box if the model has no such site.
CarBox FindCarBox(const mjModel& model);

/// Values that the caption shows at one time, in SI units and radians.
struct Readings {
  double time = 0;
  double speed = 0;
  double steering_command = 0;
  double steering = 0;
  std::optional<double> cross_track;           ///< Cross-track error [m]; nullopt if the run had no
                                               ///< planned path.
  std::optional<double> lateral_acceleration;  ///< Lateral acceleration [m/s^2]; nullopt if the log
                                               ///< has none.
  std::optional<double> tyre_use;              ///< Used fraction of grip of the tyre that uses
                                               ///< most.
  std::optional<RelativePosition> apart;       ///< Position of the first ghost relative to the car.
  std::optional<Vec2> wind;                    ///< Wind at the car [m/s]; nullopt if the run has no
                                               ///< wind.
};

/// The motion of one plant's car.
class PlantRecording {
 public:
  /// Reads `<plant>.state.csv` and `<plant>.csv` in `folder`. Throws InputError if the state file
  /// lacks the column of a joint of `model`. `index` is the plant's index among the plants of the
  /// run, and determines the plant's color.
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

  /// Position of the rear-axle center at `time`.
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
  std::vector<std::size_t> pose_columns_;  // columns of the position (x y z) and of the quaternion
                                           // (qw qx qy qz)
  std::vector<JointColumn> joints_;
  std::vector<double> headings_;  // heading of the car's x axis in each row of state_, unwrapped
                                  // [rad]
  std::size_t speed_ = 0;
  std::size_t steering_command_ = 0;
  std::size_t steering_ = 0;
  std::optional<std::size_t> cross_track_;
  std::optional<std::size_t> lateral_acceleration_;
};

/// The data of a recorded run, read from its folder.
struct Recording {
  std::string name;  ///< Name of the folder.
  std::string note;  ///< Additional text on the run; may be empty.
  World world;       ///< World of `scenario.resolved.yaml`; without that file, a flat world without
                     ///< wind.
  MujocoModel model;
  std::vector<PlantRecording> plants;        ///< The recording of the car, followed by those of the
                                             ///< ghosts.
  std::vector<Point> plan;                   ///< The initial plan; empty if the run has none.
  std::vector<NewPlan> new_plans;            ///< Plans that the car adopted later, in the order of
                                             ///< time.
  std::vector<CurvatureProfile> curvatures;  ///< Curvature of the initial and later plans; without
                                             ///< plans whose files have no curvature.
  std::optional<RoadLook> road;              ///< Road along the plan; none on open ground.
  std::optional<Track> track;                ///< Track of the run, if any; the road lies between
                                             ///< the track's edges.
  RoadPaint roads;                           ///< Paint of the world's road network; empty if the
                                             ///< world has none.
  std::vector<Point> cones;                  ///< Cones of the gates that the plan passes.
  std::vector<std::vector<Point>> gates;     ///< The four corners of each gate, between its cones.
  TyreLaw tyre = TyreLaw::kAuto;             ///< Tyre law of the plant `mujoco`.
  double steering_rate = 0;                  ///< Maximum steering rate of the car [rad/s]; 0:
                                             ///< unknown.
  std::optional<double> contact_time;        ///< Time of the first contact with an obstacle [s];
                                             ///< nullopt if there was none.
  std::optional<double> roll_over_time;      ///< Time of the roll-over [s]; nullopt if there was
                                             ///< none, or without metrics.json.
  Scales scales;  ///< Scales of this recording, possibly shared with other recordings.

  [[nodiscard]] double begin() const { return plants.front().begin(); }
  [[nodiscard]] double end() const;

  /// Returns the values that the caption shows for the car at `time` [s].
  [[nodiscard]] Readings ReadingsAt(double time) const;
  /// Returns the curvature, at the car's position, of the plan that the car follows at `time`
  /// [rad/m]. Returns nullopt if there is no plan, or after the end of the car's log.
  [[nodiscard]] std::optional<double> PlannedCurvature(double time) const;
  /// Whether the film shows a road.
  [[nodiscard]] bool has_road() const { return road || !roads.bands.empty(); }
  /// Returns the point on the ground with the x and y of `point`.
  [[nodiscard]] Point OnGround(const Point& point) const;
};

/// Returns the index of the model's geom `obstacle_i` for each obstacle i of the world; -1 for an
/// obstacle without geom.
std::vector<int> ObstacleGeoms(const Recording& recording);

/// Reads the data that a film needs, for the named plants or, if no plant is named, for all plants.
/// The first named plant is shown as the car. Throws InputError if files are missing, for example a
/// plant listed in `metrics.json` or the path of `plan.json`.
Recording ReadRecording(const std::filesystem::path& folder,
                        const std::vector<std::string>& plants = {});

}  // namespace trackbed::render
