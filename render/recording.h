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

/// Where another plant's car is at the same time, seen from the car.
struct Apart {
  std::string plant;
  double ahead = 0;  ///< along the car's heading [m]
  double left = 0;   ///< across it [m]
  /// Its station less the car's, along the path [m]; none where a log has no stations.
  std::optional<double> station{};
};

/// The box around a car, upright on the ground, in the vehicle frame [m].
struct CarBox {
  double middle = 1.3;  ///< from the rear axle ahead to its middle
  double half_length = 2.2;
  double half_width = 0.9;
  double height = 1.5;

  /// Beside a full-size car, to whose measure cameras, marks and shadows are made: 1 from a length
  /// of 4 m on.
  [[nodiscard]] double scale() const { return std::min(1.0, half_length / 2.0); }
};

/// That of the model's site `footprint`; the defaults where it has none.
CarBox FindCarBox(const mjModel& model);

/// What the caption says at a moment. SI units and radians.
struct Readings {
  double time = 0;
  double speed = 0;
  double steering_command = 0;
  double steering = 0;
  std::optional<double> cross_track;           ///< only when the run had a planned path
  std::optional<double> lateral_acceleration;  ///< where the log has it [m/s^2]
  std::optional<double> tyre_use;              ///< largest share of its grip that a tyre uses
  std::optional<Apart> apart;                  ///< of the first ghost
  std::optional<Vec2> wind;                    ///< at the car; only when the run has wind [m/s]
};

/// One plant's drive.
class PlantRecording {
 public:
  /// Of the plant of that name, from its `.state.csv` and `.csv` in `folder`; the former must have
  /// a column for every joint of `model`. InputError otherwise.
  /// `index` is its place among the plants of the run, which has its color.
  PlantRecording(const std::filesystem::path& folder, const std::string& plant,
                 const mjModel& model, std::size_t index = 0);

  [[nodiscard]] const std::string& plant() const { return plant_; }
  /// The same in every picture of the run, whichever plants it shows.
  [[nodiscard]] Color color() const { return CarColor(index_); }
  [[nodiscard]] double begin() const { return state_.begin(); }
  [[nodiscard]] double end() const { return state_.end(); }
  [[nodiscard]] const std::vector<double>& times() const { return state_.times(); }

  /// Puts the car of `data` where it was at `time` [s]; bodies' places are up to date after.
  void Pose(double time, const mjModel& model, mjData& data) const;

  /// Rear-axle center, heading [rad] (not wrapped, from the rotation of the x axis).
  [[nodiscard]] Point Position(double time) const;
  [[nodiscard]] const std::vector<double>& headings() const { return headings_; }
  [[nodiscard]] double Heading(double time) const;
  /// Cosine of the angle between the car's z axis and the world's: 1 upright, 0 on its side.
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

/// A run folder, read.
struct Recording {
  std::string name;  ///< of the folder
  std::string note;  ///< what to know of the run beside its name; else empty
  World world;       ///< of `scenario.resolved.yaml`; without that file, flat and calm
  MujocoModel model;
  std::vector<PlantRecording> plants;        ///< the car first, then the ghosts
  std::vector<Point> plan;                   ///< from the start; empty when there was none
  std::vector<NewPlan> new_plans;            ///< of the car alone, in the order of time
  std::vector<CurvatureProfile> curvatures;  ///< of both, where their files have it
  std::optional<RoadLook> road;              ///< along the plan; none: open ground
  std::optional<Track> track;                ///< of a run on one: the road is between its edges
  RoadPaint roads;                           ///< of the world's road network; empty without one
  std::vector<Point> cones;                  ///< of the gates that the plan leads through
  std::vector<std::vector<Point>> gates;     ///< of each the four corners between its cones
  TyreLaw tyre = TyreLaw::kAuto;             ///< of the plant `mujoco`
  double steering_rate = 0;                  ///< most that the car steers [rad/s]; 0: not known
  std::optional<double> contact_time;        ///< first contact with an obstacle [s]; none: never
  std::optional<double> roll_over_time;      ///< [s]; none: never, or without metrics.json
  Scales scales;                             ///< of this recording, or common with others

  [[nodiscard]] double begin() const { return plants.front().begin(); }
  [[nodiscard]] double end() const;

  /// What the caption says of the car at a moment.
  [[nodiscard]] Readings ReadingsAt(double time) const;
  /// Planned curvature [rad/m] where the car is then, by the plan that holds then; none without a
  /// plan, and after the end of the car's drive.
  [[nodiscard]] std::optional<double> PlannedCurvature(double time) const;
  /// Whether there is a road of any kind.
  [[nodiscard]] bool has_road() const { return road || !roads.bands.empty(); }
  /// The point of the ground above or below a point.
  [[nodiscard]] Point OnGround(const Point& point) const;
};

/// The geoms `obstacle_i` of the model, of each of the world's obstacles; -1 where it has none.
std::vector<int> ObstacleGeoms(const Recording& recording);

/// Reads everything that a film needs: of these plants alone, the first of them as the car, or of
/// every plant where none is named. InputError when the folder does not hold it, or not all that
/// its `metrics.json` and `plan.json` tell of.
Recording ReadRecording(const std::filesystem::path& folder,
                        const std::vector<std::string>& plants = {});

}  // namespace trackbed::render
