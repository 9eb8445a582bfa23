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

/// Position of another plant's car at the same time, relative to the car.
struct RelativePosition {
  std::string plant;
  double ahead = 0;  ///< along the car's heading [m]
  double left = 0;   ///< to the left [m]
  /// Its station less the car's, along the path [m]; none if a log has no stations.
  std::optional<double> station{};
};

/// Bounding box of a car, upright on the ground, in the vehicle frame [m].
struct CarBox {
  double middle = 1.3;  ///< x of its center, from the rear axle
  double half_length = 2.2;
  double half_width = 0.9;
  double height = 1.5;

  /// Size relative to a full-size car, for which cameras, marks and shadows are made: 1 from a
  /// length of 4 m on.
  [[nodiscard]] double scale() const { return std::min(1.0, half_length / 2.0); }
};

/// The box of the model's site `footprint`; the defaults without such a site.
CarBox FindCarBox(const mjModel& model);

/// Values shown in the caption at one time. SI units and radians.
struct Readings {
  double time = 0;
  double speed = 0;
  double steering_command = 0;
  double steering = 0;
  std::optional<double> cross_track;           ///< only when the run had a planned path
  std::optional<double> lateral_acceleration;  ///< if the log has it [m/s^2]
  std::optional<double> tyre_use;              ///< largest fraction of its grip that a tyre uses
  std::optional<RelativePosition> apart;       ///< of the first ghost
  std::optional<Vec2> wind;                    ///< at the car; only if the run has wind [m/s]
};

/// The motion of one plant's car.
class PlantRecording {
 public:
  /// Reads `.state.csv` and `.csv` of that plant in `folder`; the former must have a column for
  /// every joint of `model`, otherwise InputError. `index` is the plant's index among those of the
  /// run, which determines its color.
  PlantRecording(const std::filesystem::path& folder, const std::string& plant,
                 const mjModel& model, std::size_t index = 0);

  [[nodiscard]] const std::string& plant() const { return plant_; }
  /// The same in all films of a run, whichever plants they show.
  [[nodiscard]] Color color() const { return CarColor(index_); }
  [[nodiscard]] double begin() const { return state_.begin(); }
  [[nodiscard]] double end() const { return state_.end(); }
  [[nodiscard]] const std::vector<double>& times() const { return state_.times(); }

  /// Sets `data` to the car's state at `time` [s] and updates the poses of its bodies.
  void Pose(double time, const mjModel& model, mjData& data) const;

  /// Rear-axle center, and heading [rad], unwrapped, by the rotation of the x axis.
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
  std::vector<std::size_t> pose_columns_;  // x y z qw qx qy qz
  std::vector<JointColumn> joints_;
  std::vector<double> headings_;  // per row of state_
  std::size_t speed_ = 0;
  std::size_t steering_command_ = 0;
  std::size_t steering_ = 0;
  std::optional<std::size_t> cross_track_;
  std::optional<std::size_t> lateral_acceleration_;
};

/// The contents of a run folder.
struct Recording {
  std::string name;  ///< name of the folder
  std::string note;  ///< additional text on the run; may be empty
  World world;       ///< from `scenario.resolved.yaml`; without that file, flat and calm
  MujocoModel model;
  std::vector<PlantRecording> plants;        ///< the car first, then the ghosts
  std::vector<Point> plan;                   ///< the initial plan; empty without one
  std::vector<NewPlan> new_plans;            ///< of the car only, in order of time
  std::vector<CurvatureProfile> curvatures;  ///< of both, if their files have it
  std::optional<RoadLook> road;              ///< along the plan; none: open ground
  std::optional<Track> track;                ///< for runs on one: the road is between its edges
  RoadPaint roads;                           ///< of the world's road network; empty without one
  std::vector<Point> cones;                  ///< of the gates that the plan passes
  std::vector<std::vector<Point>> gates;     ///< the four corners of each, between its cones
  TyreLaw tyre = TyreLaw::kAuto;             ///< of the plant `mujoco`
  double steering_rate = 0;                  ///< largest one of the car [rad/s]; 0: unknown
  std::optional<double> contact_time;        ///< first contact with an obstacle [s]; none: never
  std::optional<double> roll_over_time;      ///< [s]; none: never, or without metrics.json
  Scales scales;                             ///< of this recording, or shared with others

  [[nodiscard]] double begin() const { return plants.front().begin(); }
  [[nodiscard]] double end() const;

  /// The caption's values for the car at a time.
  [[nodiscard]] Readings ReadingsAt(double time) const;
  /// Curvature [rad/m] of the plan valid at `time`, at the car's position. None without a plan, and
  /// after the end of the car's log.
  [[nodiscard]] std::optional<double> PlannedCurvature(double time) const;
  /// Whether any road is drawn.
  [[nodiscard]] bool has_road() const { return road || !roads.bands.empty(); }
  /// The point of the ground with the same x and y.
  [[nodiscard]] Point OnGround(const Point& point) const;
};

/// The geoms `obstacle_i` of the model for the world's obstacles; -1 if it has none.
std::vector<int> ObstacleGeoms(const Recording& recording);

/// Reads everything that a film needs: for the named plants, the first of them as the car, or for
/// all plants if none is named. InputError if files are missing, for example a plant listed in
/// `metrics.json` or the path of `plan.json`.
Recording ReadRecording(const std::filesystem::path& folder,
                        const std::vector<std::string>& plants = {});

}  // namespace trackbed::render
