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

/// Position of another plant's car at the same time, relative to the recorded car.
struct RelativePosition {
  std::string plant;
  double ahead = 0;  ///< Distance along the car's heading [m].
  double left = 0;   ///< Distance to the left of the car [m].
  /// Station of the other car less that of the car, along the path [m]; none if a log has no
  /// stations.
  std::optional<double> station{};
};

/// Bounding box of a car, upright on the ground, in the vehicle frame [m].
struct CarBox {
  double middle = 1.3;  ///< x of the box's center, from the rear axle
  double half_length = 2.2;
  double half_width = 0.9;
  double height = 1.5;

  /// Size relative to the full-size car for which cameras, marks and shadows are made. Cars from 4
  /// m long have size 1.
  [[nodiscard]] double scale() const { return std::min(1.0, half_length / 2.0); }
};

/// The box of the model's site `footprint`; the default box without such a site.
CarBox FindCarBox(const mjModel& model);

/// Values shown in the caption at one time. Readings are in SI units and radians.
struct Readings {
  double time = 0;
  double speed = 0;
  double steering_command = 0;
  double steering = 0;
  std::optional<double> cross_track;           ///< Cross-track error; only if the run had a planned
                                               ///< path.
  std::optional<double> lateral_acceleration;  ///< Lateral acceleration, if the log has it [m/s^2].
  std::optional<double> tyre_use;              ///< Largest fraction of a tyre's grip in use.
  std::optional<RelativePosition> apart;       ///< Position of the first ghost relative to the car.
  std::optional<Vec2> wind;                    ///< Wind at the car, only if the run has wind [m/s].
};

/// The motion of one plant's car.
class PlantRecording {
 public:
  /// Reads `<plant>.state.csv` and `<plant>.csv` in `folder`. Throws InputError if the state file
  /// lacks the column of a joint of `model`. `index` is the plant's index among those of the run
  /// and determines the plant's color.
  PlantRecording(const std::filesystem::path& folder, const std::string& plant,
                 const mjModel& model, std::size_t index = 0);

  [[nodiscard]] const std::string& plant() const { return plant_; }
  /// The color of a plant, which is the same in all films of a run.
  [[nodiscard]] Color color() const { return CarColor(index_); }
  [[nodiscard]] double begin() const { return state_.begin(); }
  [[nodiscard]] double end() const { return state_.end(); }
  [[nodiscard]] const std::vector<double>& times() const { return state_.times(); }

  /// Sets `data` to the car's state at `time` [s] and updates the poses of its bodies.
  void Pose(double time, const mjModel& model, mjData& data) const;

  /// Rear-axle center, and heading of the x axis, unwrapped [rad].
  [[nodiscard]] Point Position(double time) const;
  [[nodiscard]] const std::vector<double>& headings() const { return headings_; }
  [[nodiscard]] double Heading(double time) const;
  /// Cosine of the angle between the car's z axis and the vertical: 1 upright, 0 on its side.
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
  std::vector<std::size_t> pose_columns_;  // columns of position (x y z) and quaternion (qw qx qy
                                           // qz)
  std::vector<JointColumn> joints_;
  std::vector<double> headings_;  // headings, per row of state_
  std::size_t speed_ = 0;
  std::size_t steering_command_ = 0;
  std::size_t steering_ = 0;
  std::optional<std::size_t> cross_track_;
  std::optional<std::size_t> lateral_acceleration_;
};

/// The recorded data of a run folder.
struct Recording {
  std::string name;  ///< Name of the folder.
  std::string note;  ///< Additional text on the run; may be empty.
  World world;       ///< World of `scenario.resolved.yaml`; flat and calm without that file.
  MujocoModel model;
  std::vector<PlantRecording> plants;        ///< The car's recording first, then those of the
                                             ///< ghosts.
  std::vector<Point> plan;                   ///< The initial plan; empty without one.
  std::vector<NewPlan> new_plans;            ///< Later plans of the car, in the order of time.
  std::vector<CurvatureProfile> curvatures;  ///< Curvatures of the initial and later plans, if
                                             ///< their files have them.
  std::optional<RoadLook> road;              ///< Road along the plan; none on open ground.
  std::optional<Track> track;                ///< Track of the run, if any: the road is between its
                                             ///< edges.
  RoadPaint roads;                           ///< Paint of the world's road network; empty without
                                             ///< one.
  std::vector<Point> cones;                  ///< Cones of the gates that the plan passes.
  std::vector<std::vector<Point>> gates;     ///< The four corners of each gate, between its cones.
  TyreLaw tyre = TyreLaw::kAuto;             ///< Tyre law of the plant `mujoco`.
  double steering_rate = 0;                  ///< Maximum steering rate of the car [rad/s]; 0:
                                             ///< unknown.
  std::optional<double> contact_time;        ///< Time of the first contact with an obstacle [s];
                                             ///< none: never.
  std::optional<double> roll_over_time;      ///< Time of the roll-over [s]; none: never, or no
                                             ///< metrics.json.
  Scales scales;                             ///< Scales of this recording, or shared with others.

  [[nodiscard]] double begin() const { return plants.front().begin(); }
  [[nodiscard]] double end() const;

  /// The values that the caption shows for the car at `time`.
  [[nodiscard]] Readings ReadingsAt(double time) const;
  /// Curvature at the car's position of the plan that is valid at `time` [rad/m]. PlannedCurvature
  /// returns none without a plan or after the end of the car's log.
  [[nodiscard]] std::optional<double> PlannedCurvature(double time) const;
  /// Whether any road is drawn.
  [[nodiscard]] bool has_road() const { return road || !roads.bands.empty(); }
  /// The point of the ground with the given x and y.
  [[nodiscard]] Point OnGround(const Point& point) const;
};

/// The model's geoms `obstacle_i` of the world's obstacles; -1 for an obstacle without geom.
std::vector<int> ObstacleGeoms(const Recording& recording);

/// Reads all that a film needs, for the named plants or, if none is named, for all. The first named
/// plant is shown as the car. Throws InputError if files are missing, for example a plant listed in
/// `metrics.json` or the path of `plan.json`.
Recording ReadRecording(const std::filesystem::path& folder,
                        const std::vector<std::string>& plants = {});

}  // namespace trackbed::render
