#pragma once

#include <array>
#include <cstddef>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/watch/drive_clock.h"
#include "trackbed/analysis/run.h"
#include "trackbed/report/live.h"

namespace trackbed {

/// A run in progress, shared by several threads. Threads of the plants add rows; connections send
/// them. All functions of LiveRun are thread-safe.
class LiveRun {
 public:
  /// `first` is the ReportData at the beginning of the run, as for LivePage. `id` identifies the
  /// run.
  LiveRun(const nlohmann::ordered_json& first, std::string id, double control_period, double speed,
          bool paused);

  /// Hooks for the simulation of a plant and for its end.
  DriveHooks HooksOf(const std::string& plant);
  void EndOf(const std::string& plant);

  /// Releases the plants from the clock and ends them at once.
  void Interrupt();
  /// Called when the report of the run can be loaded.
  void Finish();

  /// The part of the run that a connection has sent to its page.
  struct Cursor {
    std::string state;                                 ///< State that was sent last.
    std::vector<std::array<std::size_t, 3>> places{};  ///< Numbers of sent rows, poses and plans of
                                                       ///< each plant.
    bool finished = false;
  };

  /// The next message for a page as JSON; none if the page is up to date. The messages are:
  ///   {"type": "state", "id", "paused", "speed"}  speed is a number or "max"
  ///   {"type": "rows", "plants": [{"first": [row, pose, plan], "rows", "poses", "plans"}, ...]}
  ///   {"type": "finished"}                        after all rows
  /// Rows are those of LiveRows, and a message has at most about 100 kB.
  std::optional<std::string> Next(Cursor& cursor) const;

  /// Executes a command of a page: {"do": "pause" | "resume" | "step"}, or {"do": "speed", "speed":
  /// number | "max"}. Execute returns the error in the message; empty if the command was executed.
  std::string Execute(std::string_view message);

 private:
  struct Plant {
    std::string name;
    LiveRows text;
    std::array<std::vector<std::string>, 3> added{};  // added rows, poses and plans
    std::size_t configurations_seen = 0;
    double next_pose = 0.0;  // [s]
    std::size_t changes_seen = 0;
  };

  std::size_t IndexOf(const std::string& plant) const;
  void Add(std::size_t plant, const RunLog& log, const Table& configurations);
  [[nodiscard]] std::string StateText() const;
  [[nodiscard]] std::optional<std::string> RowsText(Cursor& cursor) const;

  std::string id_;
  DriveClock clock_;
  mutable std::mutex mutex_;  // guards the following members
  std::vector<Plant> plants_;
  bool interrupted_ = false;
  bool finished_ = false;
};

}  // namespace trackbed
