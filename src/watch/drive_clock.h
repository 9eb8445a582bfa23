#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

/// Clock of a watched run.
namespace trackbed {

/// Relates simulated time to wall-clock time. All times of Pace are in seconds.
class Pace {
 public:
  /// `speed` is simulated time over wall time, > 0. Infinite speed means as fast as possible.
  Pace(double speed, bool paused) : speed_(speed), paused_(paused) {}

  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] bool paused() const { return paused_; }

  /// Largest simulated time allowed at the wall-clock time `wall`; infinite at infinite speed.
  [[nodiscard]] double AllowedAt(double wall) const;
  /// Wall-clock time at which `simulated` is allowed; infinite if only another call can allow it.
  [[nodiscard]] double MomentOf(double simulated) const;

  // The functions below have two times: `simulated` is the simulated time reached, `wall` the
  // wall-clock time of the call.

  void Pause(double simulated);
  void Resume(double simulated, double wall);
  /// Pauses and allows one `period` more than the time reached or already allowed.
  void Step(double simulated, double period);
  void SetSpeed(double speed, double simulated, double wall);
  /// Restarts the clock if the simulation is too slow, so that the simulation does not catch up
  /// later.
  void KeepUp(double simulated, double wall);

 private:
  void CountFrom(double simulated, double wall);

  double speed_;
  bool paused_;
  double until_ = 0.0;           // Limit of the simulated time while paused.
  double from_simulated_ = 0.0;  // Simulated time from which the speed counts.
  double from_wall_ = 0.0;
};

/// Synchronizes the plants of a run, one thread each. No plant begins a control period before all
/// others have reached it. All functions of DriveClock are thread-safe.
class DriveClock {
 public:
  /// `period` is the control period [s].
  DriveClock(std::size_t plants, double period, double speed, bool paused);

  /// Reports that a plant has reached `time` [s]. Advance() returns when the plant may simulate the
  /// next control period.
  void Advance(std::size_t plant, double time);
  /// Removes a plant from the synchronization.
  void End(std::size_t plant);
  /// Ends all waiting, now and later.
  void Release();

  void Pause();
  void Resume();
  /// Pauses after all plants have simulated one more control period.
  void Step();
  /// Same as Pace::SetSpeed.
  void SetSpeed(double speed);

  struct State {
    bool paused = false;
    double speed = 1.0;
  };
  [[nodiscard]] State state() const;

 private:
  [[nodiscard]] double SlowestTime() const;  // Time of the slowest participating plant [s].
  [[nodiscard]] double Reached() const;      // Time that all plants have reached [s]; 0 before they
                                             // have begun.
  [[nodiscard]] double Now() const;          // Time of the wall clock [s].

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double period_;
  mutable std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  Pace pace_;
  std::vector<double> times_;  // time of each plant; negative before it has begun, infinite after
                               // its end
  bool released_ = false;
};

}  // namespace trackbed
