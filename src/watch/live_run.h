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

/// The data of a run in progress. The threads of the plants add rows, and connections send the rows
/// to pages. All functions of LiveRun are thread-safe.
class LiveRun {
 public:
  /// `first` is the ReportData at the beginning of the run, which LivePage also gets. `id`
  /// identifies the run.
  LiveRun(const nlohmann::ordered_json& first, std::string id, double control_period, double speed,
          bool paused);

  /// Returns the hooks for the simulation of a plant.
  DriveHooks HooksOf(const std::string& plant);
  void EndOf(const std::string& plant);

  /// Ends the simulations of all plants immediately, including those that wait for the clock.
  void Interrupt();
  /// Tells all pages that the report of the run can be loaded.
  void Finish();

  /// Records which part of the run a connection has already sent to its page.
  struct Cursor {
    std::string state;                                 ///< State message that was sent last.
    std::vector<std::array<std::size_t, 3>> places{};  ///< For each plant, the numbers of rows,
                                                       ///< poses and plans sent so far.
    bool finished = false;
  };

  /// Returns the next message for a page as JSON; nullopt if the page is up to date. The messages
  /// are:
  ///   {"type": "state", "id", "paused", "speed"}  speed is a number or "max"
  ///   {"type": "rows", "plants": [{"first": [row, pose, plan], "rows", "poses", "plans"}, ...]}
  ///   {"type": "finished"}                        after all rows
  /// LiveRows formats the rows. A message has at most about 100 kB.
  std::optional<std::string> Next(Cursor& cursor) const;

  /// Executes a command from a page: {"do": "pause" | "resume" | "step"}, or {"do": "speed",
  /// "speed": number | "max"}. Returns a text on the error in the command; empty if the command was
  /// executed.
  std::string Execute(std::string_view message);

 private:
  struct Plant {
    std::string name;
    LiveRows text;
    std::array<std::vector<std::string>, 3> added{};  // rows, poses and plans added so far
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
