#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

namespace trackbed {

/// Pose of a car of an artificial run: rear-axle center [m] and heading [rad].
struct CarPlace {
  double x = 0;
  double y = 0;
  double heading = 0;
};
using Motion = std::function<CarPlace(double time)>;

inline const std::vector<std::string>& PriusJointColumns() {
  static const std::vector<std::string> columns{
      "suspension_fl_m", "suspension_fr_m", "suspension_rl_m", "suspension_rr_m",
      "steer_fl_rad",    "steer_fr_rad",    "rack_rad",        "spin_fl_rad",
      "spin_fr_rad",     "spin_rl_rad",     "spin_rr_rad"};
  return columns;
}

/// Writes the files of one plant: states every 1/60 s, the log every 20 ms.
inline void WritePlant(const std::filesystem::path& folder, const std::string& plant,
                       double duration, const Motion& motion) {
  std::vector<std::string> columns{"t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"};
  columns.insert(columns.end(), PriusJointColumns().begin(), PriusJointColumns().end());
  Table state(columns);
  const auto state_rows = static_cast<int>(std::lround(duration * 60.0));
  for (int i = 0; i <= state_rows; ++i) {
    const double time = duration * i / state_rows;
    const CarPlace car = motion(time);
    std::vector<double> row{time,
                            car.x,
                            car.y,
                            0.0,
                            std::cos(0.5 * car.heading),
                            0.0,
                            0.0,
                            std::sin(0.5 * car.heading)};
    row.resize(columns.size(), 0.0);
    state.AddRow(row);
  }
  WriteFileAtomically(folder / (plant + ".state.csv"), state.ToCsv());

  Table log({"t_s", "x_m", "y_m", "yaw_rad", "speed_mps", "steering_command_rad",
             "steering_actuator_rad", "steering_rad", "s_m", "cross_track_m", "heading_error_rad"});
  const auto log_rows = static_cast<int>(std::lround(duration * 50.0));
  for (int i = 0; i <= log_rows; ++i) {
    const double time = duration * i / log_rows;
    const CarPlace car = motion(time);
    log.AddRow({time, car.x, car.y, car.heading, 3.0, 0.1, 0.09, 0.08, 3.0 * time, 0.01, 0.0});
  }
  WriteFileAtomically(folder / (plant + ".csv"), log.ToCsv());
}

/// Adds a column to a plant's log, or replaces its values.
inline void SetLogColumn(const std::filesystem::path& folder, const std::string& plant,
                         const std::string& column, const std::function<double(double)>& value) {
  const std::filesystem::path file = folder / (plant + ".csv");
  const Table before = ReadCsv(file);
  std::vector<std::string> columns = before.columns();
  const int found = before.Find(column);
  if (found < 0) {
    columns.push_back(column);
  }
  Table after(columns);
  for (std::size_t row = 0; row < before.rows(); ++row) {
    std::vector<double> cells;
    for (std::size_t i = 0; i < before.columns().size(); ++i) {
      cells.push_back(before.at(row, i));
    }
    if (found < 0) {
      cells.push_back(0.0);
    }
    cells[found < 0 ? cells.size() - 1 : static_cast<std::size_t>(found)] = value(cells[0]);
    after.AddRow(cells);
  }
  WriteFileAtomically(file, after.ToCsv());
}

inline void CopyPrius(const std::filesystem::path& folder) {
  std::filesystem::copy_file(
      std::filesystem::path(TRACKBED_SOURCE_DIR) / "models" / "prius" / "prius.xml",
      folder / "model.xml");
}

/// Adds elements to the world of the run's model.
inline void InsertIntoModel(const std::filesystem::path& folder, const std::string& elements) {
  const std::filesystem::path model = folder / "model.xml";
  std::string xml = ReadFile(model);
  xml.insert(xml.rfind("</worldbody>"), elements);
  WriteFileAtomically(model, xml);
}

/// A straight plan along the x axis from 0 to `length` [m].
inline void WriteStraightPlan(const std::filesystem::path& folder, double length) {
  Table plan({"s_m", "x_m", "y_m", "yaw_rad", "curvature_radpm", "speed_mps", "direction"});
  const auto rows = static_cast<int>(std::lround(length / 0.1));
  for (int i = 0; i <= rows; ++i) {
    plan.AddRow({length * i / rows, length * i / rows, 0.0, 0.0, 0.0, 3.0, 1.0});
  }
  WriteFileAtomically(folder / "plan.csv", plan.ToCsv());
}

/// A straight replan: parallel to the x axis at `y`, up to `length`.
struct NewLine {
  double from = 0;  // [s]
  double y = 0;
  double length = 0;
};

inline void WriteNewPlans(const std::filesystem::path& folder, const std::string& plant,
                          const std::vector<NewLine>& lines) {
  Table plans(
      {"from_t_s", "s_m", "x_m", "y_m", "yaw_rad", "curvature_radpm", "speed_mps", "direction"});
  for (const NewLine& line : lines) {
    const auto rows = static_cast<int>(std::lround(line.length / 0.1));
    for (int i = 0; i <= rows; ++i) {
      const double x = line.length * i / rows;
      plans.AddRow({line.from, x, x, line.y, 0.0, 0.0, 3.0, 1.0});
    }
  }
  WriteFileAtomically(folder / (plant + ".plan.csv"), plans.ToCsv());
}

}  // namespace trackbed
