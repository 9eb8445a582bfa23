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

/// Slowest and fastest playback speed of a live run, as ratio of simulated time to real time.
inline constexpr double kMinPlaybackSpeed = 0.01;
inline constexpr double kMaxPlaybackSpeed = 1000.0;

/// Stores the data of a run in progress. The threads of the plants add rows, and the connections
/// send these rows to pages. All functions of LiveRun are thread-safe.
class LiveRun {
 public:
  /// `first` is the report data at the beginning of the run, which are also passed to LivePage.
  /// `id` identifies the run, so that pages notice a new run.
  LiveRun(const nlohmann::ordered_json& first, std::string id, double control_period, double speed,
          bool paused);

  /// Returns the functions that the simulation of a plant calls.
  DriveHooks HooksOf(const std::string& plant);
  void EndOf(const std::string& plant);

  /// Ends the simulations of all plants immediately, including plants that wait for the clock.
  void Interrupt();
  /// Tells all pages that the report of the run can be loaded.
  void Finish();

  /// Position in the data of the run up to which data has been sent to the page of a connection.
  struct Cursor {
    std::string state;  ///< Last state message that was sent to the page.
    /// For each plant, the number of rows, of poses and of plans sent so far.
    std::vector<std::array<std::size_t, 3>> places{};
    bool finished = false;
  };

  /// Returns the next JSON message for a page; nullopt if the page is up to date. The messages are:
  ///   {"type": "state", "id", "paused", "speed"}  speed is a number or "max"
  ///   {"type": "rows", "plants": [{"first": [row, pose, plan], "rows", "poses", "plans"}, ...]}
  ///   {"type": "finished"}                        after all rows
  /// The class LiveRows formats the rows of the log. The size of a message to a page is at most
  /// about 100 kB.
  std::optional<std::string> Next(Cursor& cursor) const;

  /// Executes a command that a page has sent; commands are {"do": "pause" | "resume" | "step"} and
  /// {"do": "speed", "speed": number | "max"}. Returns an error message if the command of the page
  /// is invalid, else an empty text.
  std::string Execute(std::string_view message);

 private:
  struct Plant {
    std::string name;
    LiveRows text;
    // JSON texts of the rows, poses and plans added so far
    std::array<std::vector<std::string>, 3> added{};
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
  mutable std::mutex mutex_;  // protects the members below against concurrent access
  std::vector<Plant> plants_;
  bool interrupted_ = false;
  bool finished_ = false;
};

}  // namespace trackbed
