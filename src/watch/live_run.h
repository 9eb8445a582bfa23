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

/// A run that goes on, between the threads of its plants, which add rows, and the connections,
/// which take them. Every function may be called by any thread.
class LiveRun {
 public:
  /// `first` is ReportData of the run when it begins, as for LivePage; `id` tells it from others.
  LiveRun(const nlohmann::ordered_json& first, std::string id, double control_period, double speed,
          bool paused);

  /// The hooks of the plant of that name, and of its end.
  DriveHooks HooksOf(const std::string& plant);
  void EndOf(const std::string& plant);

  /// The plants no longer wait for the clock, and end at once.
  void Interrupt();
  /// The report of the run is there to be loaded.
  void Finish();

  /// How much of the run a connection has told its page.
  struct Cursor {
    std::string state;                                 ///< told last
    std::vector<std::array<std::size_t, 3>> places{};  ///< rows, poses and plans of each plant
    bool finished = false;
  };

  /// What a page is to be told next, as JSON; none when it knows everything so far. One of
  ///   {"type": "state", "id", "paused", "speed"}  speed is a number or "max"
  ///   {"type": "rows", "plants": [{"first": [row, pose, plan], "rows", "poses", "plans"}, ...]}
  ///   {"type": "finished"}                        after all rows
  /// Rows are those of LiveRows; a message has at most some 100 kB.
  std::optional<std::string> Next(Cursor& cursor) const;

  /// Does what a page asks for: {"do": "pause" | "resume" | "step"}, or {"do": "speed", "speed":
  /// number | "max"}. Gives back what is wrong with the message, empty if it was obeyed.
  std::string Obey(std::string_view message);

 private:
  struct Plant {
    std::string name;
    LiveRows text;
    std::array<std::vector<std::string>, 3> added{};  // rows, poses, plans
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
  mutable std::mutex mutex_;  // of what follows
  std::vector<Plant> plants_;
  bool interrupted_ = false;
  bool finished_ = false;
};

}  // namespace trackbed
