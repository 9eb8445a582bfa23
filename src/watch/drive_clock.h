#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

/// Synchronizes a watched run with the wall clock.
namespace trackbed {

/// Relates simulated time to wall-clock time. All times are in seconds.
class Pace {
 public:
  /// `speed` > 0 is the ratio of simulated time to wall-clock time. Infinity means as fast as
  /// possible.
  Pace(double speed, bool paused) : speed_(speed), paused_(paused) {}

  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] bool paused() const { return paused_; }

  /// Returns the simulated time that may be reached at the wall-clock time `wall`; infinity if the
  /// speed is infinite.
  [[nodiscard]] double AllowedAt(double wall) const;
  /// Returns the wall-clock time at which the simulated time `simulated` may be reached. Returns
  /// infinity if the clock is paused before that time.
  [[nodiscard]] double MomentOf(double simulated) const;

  // In the functions below, `simulated` is the simulated time reached so far, and `wall` is the
  // wall-clock time of the call.

  void Pause(double simulated);
  void Resume(double simulated, double wall);
  /// Pauses the clock after one more `period`, counted from the time reached or already allowed.
  void Step(double simulated, double period);
  void SetSpeed(double speed, double simulated, double wall);
  /// Restarts the clock if the simulation lags behind, so that the simulation does not run faster
  /// later to catch up.
  void KeepUp(double simulated, double wall);

 private:
  void CountFrom(double simulated, double wall);

  double speed_;
  bool paused_;
  double until_ = 0.0;           // Limit of the simulated time while paused.
  double from_simulated_ = 0.0;  // Simulated time at which the present speed began to apply.
  double from_wall_ = 0.0;
};

/// Synchronizes the plants of a run, each of which has its own thread. No plant begins a control
/// period before all other plants have reached it. All functions of DriveClock are thread-safe.
class DriveClock {
 public:
  /// `period` is the control period [s].
  DriveClock(std::size_t plants, double period, double speed, bool paused);

  /// Called by a plant that has reached `time` [s]. Blocks until the plant may simulate the next
  /// control period.
  void Advance(std::size_t plant, double time);
  /// Removes a plant from the synchronization, so that other plants no longer wait for it.
  void End(std::size_t plant);
  /// Makes all present and future calls of Advance() return immediately.
  void Release();

  void Pause();
  void Resume();
  /// Pauses the run after all plants have simulated one more control period.
  void Step();
  /// Same as Pace::SetSpeed.
  void SetSpeed(double speed);

  struct State {
    bool paused = false;
    double speed = 1.0;
  };
  [[nodiscard]] State state() const;

 private:
  [[nodiscard]] double SlowestTime() const;  // Smallest time of all plants that have not ended [s].
  [[nodiscard]] double Reached() const;      // Time that all plants have reached [s]; 0 until all
                                             // have begun.
  [[nodiscard]] double Now() const;          // Wall-clock time [s].

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double period_;
  mutable std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  Pace pace_;
  std::vector<double> times_;  // time of each plant; negative before the plant has begun, infinite
                               // after its end
  bool released_ = false;
};

}  // namespace trackbed
