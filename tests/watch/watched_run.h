#pragma once

#include <atomic>
#include <filesystem>
#include <future>
#include <string>

#include "tests/support/temp_folder.h"
#include "tests/watch/client.h"
#include "trackbed/drive/drive.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/watch/watch.h"

namespace trackbed {

/// A corner of some 10 s; `keys`: YAML sections besides the mission.
inline Scenario Corner(const std::string& keys = "drive: {plants: [kinematic]}\n") {
  return ParseScenario(
      "schema: 1\n"
      "name: corner\n"
      "mission: {speed: 3, waypoints: [[0, 0], [15, 0], [15, 15]]}\n"
      "plan: {method: fillet}\n" +
          keys,
      "corner.yaml", ".");
}

/// Executes WatchRun in a thread and interrupts it in the destructor at the latest.
class WatchedRun {
 public:
  WatchedRun(const Scenario& scenario, const std::filesystem::path& folder, WatchOptions options) {
    std::promise<std::string> serving;
    std::future<std::string> url = serving.get_future();
    result_ = std::async(std::launch::async, [this, scenario, folder, options,
                                              serving = std::move(serving)]() mutable {
      return WatchRun(scenario, LoadCar(scenario), folder, options,
                      {.serving = [&](const std::string& where) { serving.set_value(where); },
                       .interrupted = [this] { return interrupted_.load(); },
                       .finished = [this](const RunResult&) { ++finished_; }});
    });
    url_ = url.get();
  }
  WatchedRun(const WatchedRun&) = delete;
  WatchedRun& operator=(const WatchedRun&) = delete;
  ~WatchedRun() { interrupted_ = true; }

  [[nodiscard]] const std::string& url() const { return url_; }
  [[nodiscard]] std::uint16_t port() const { return PortOf(url_); }
  [[nodiscard]] int finished() const { return finished_; }
  /// Interrupts the run like Ctrl-C.
  RunResult Interrupt() {
    interrupted_ = true;
    return result_.get();
  }

 private:
  std::atomic<bool> interrupted_{false};
  std::atomic<int> finished_{0};
  std::string url_;
  std::future<RunResult> result_;
};

}  // namespace trackbed
