#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

/// Synchronizes a watched run with the wall clock.
namespace trackbed {

/// Relates the simulated time of a run to wall-clock time. All times of the class Pace are in
/// seconds.
class Pace {
 public:
  /// `speed` > 0 is the ratio of simulated time to wall-clock time. An infinite `speed` means that
  /// the simulation runs as fast as possible.
  Pace(double speed, bool paused) : speed_(speed), paused_(paused) {}

  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] bool paused() const { return paused_; }

  /// Returns the simulated time that the simulation may reach at the wall-clock time `wall`;
  /// infinity if the speed is infinite.
  [[nodiscard]] double AllowedAt(double wall) const;
  /// Returns the wall-clock time from which the simulation may reach the simulated time
  /// `simulated`. MomentOf returns infinity if the clock is paused before it reaches `simulated`.
  [[nodiscard]] double MomentOf(double simulated) const;

  // Arguments of the member functions of Pace: `simulated` is the simulated time reached so far,
  // and `wall` is the wall-clock time of the call.

  void Pause(double simulated);
  void Resume(double simulated, double wall);
  /// Pauses the clock after one more control period `period`, counted from the simulated time that
  /// is reached or already allowed.
  void Step(double simulated, double period);
  void SetSpeed(double speed, double simulated, double wall);
  /// If the simulation lags behind the wall clock, shifts the clock by the lag, so that the
  /// simulation does not run faster later to catch up.
  void KeepUp(double simulated, double wall);

 private:
  void CountFrom(double simulated, double wall);

  double speed_;
  bool paused_;
  // Largest simulated time that the simulation may reach while the clock is paused [s].
  double until_ = 0.0;
  double from_simulated_ = 0.0;  // Simulated time from which the clock's present speed applies.
  double from_wall_ = 0.0;
};

/// Synchronizes the plants of a run, each of which has its own thread. A plant begins a control
/// period only when all other plants have reached the start of this period. A pause begins at the
/// end of a control period, so that all plants stop at the same simulated time. All functions of
/// DriveClock are thread-safe.
class DriveClock {
 public:
  /// `period` is the control period of the run [s].
  DriveClock(std::size_t plants, double period, double speed, bool paused);

  /// Advance() is called by the thread of a plant that has reached the simulated time `time` [s].
  /// Advance() blocks until the plant may simulate its next control period.
  void Advance(std::size_t plant, double time);
  /// Removes a plant from the synchronization, so that other plants no longer wait for it.
  void End(std::size_t plant);
  /// Releases all plants: present and future calls of Advance() return immediately.
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
  // Smallest simulated time of all plants that have not ended [s].
  [[nodiscard]] double SlowestTime() const;
  [[nodiscard]] double Now() const;  // Wall-clock time [s].

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double period_;
  mutable std::mutex mutex_;  // protects the members below against concurrent access
  std::condition_variable changed_;
  Pace pace_;
  // simulated time of each plant; negative before the plant has begun, infinite after its end
  std::vector<double> times_;
  double begun_ = 0.0;  // end of the last control period that a plant has begun [s]
  bool released_ = false;
};

}  // namespace trackbed
