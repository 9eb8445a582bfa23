#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

/// Clock of a watched run.
namespace trackbed {

/// Relates simulated time to wall-clock time. All times are in seconds.
class Pace {
 public:
  /// `speed` is simulated time over wall time, > 0; infinite for as fast as possible.
  Pace(double speed, bool paused) : speed_(speed), paused_(paused) {}

  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] bool paused() const { return paused_; }

  /// Largest simulated time allowed at `wall`; infinite at infinite speed.
  [[nodiscard]] double AllowedAt(double wall) const;
  /// Wall-clock time at which `simulated` is allowed; infinite if only another call can allow it.
  [[nodiscard]] double MomentOf(double simulated) const;

  // In the calls below, `simulated` is the simulated time reached and `wall` the wall-clock time of
  // the call.

  void Pause(double simulated);
  void Resume(double simulated, double wall);
  /// Pauses and allows one `period` more than the time reached or already allowed.
  void Step(double simulated, double period);
  void SetSpeed(double speed, double simulated, double wall);
  /// Restarts counting if the simulation is too slow, so that it does not catch up later.
  void KeepUp(double simulated, double wall);

 private:
  void CountFrom(double simulated, double wall);

  double speed_;
  bool paused_;
  double until_ = 0.0;           // limit while paused
  double from_simulated_ = 0.0;  // origin of the speed
  double from_wall_ = 0.0;
};

/// Synchronizes the plants of a run, one thread each: no plant begins a control period before all
/// others have reached it. All functions are thread-safe.
class DriveClock {
 public:
  /// `period` is the control period [s].
  DriveClock(std::size_t plants, double period, double speed, bool paused);

  /// Called by a plant that has reached `time` [s]. Returns when it may simulate the next control
  /// period.
  void Advance(std::size_t plant, double time);
  /// Removes a plant from the synchronization.
  void End(std::size_t plant);
  /// Ends all waiting, now and later.
  void Release();

  void Pause();
  void Resume();
  /// Pauses; all plants simulate one control period.
  void Step();
  /// Same as Pace::SetSpeed.
  void SetSpeed(double speed);

  struct State {
    bool paused = false;
    double speed = 1.0;
  };
  [[nodiscard]] State state() const;

 private:
  [[nodiscard]] double SlowestTime() const;  // of the participating plants [s]
  [[nodiscard]] double Reached() const;      // by all plants [s]; 0 before they have begun
  [[nodiscard]] double Now() const;          // wall clock [s]

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double period_;
  mutable std::mutex mutex_;  // guards the following members
  std::condition_variable changed_;
  Pace pace_;
  std::vector<double> times_;  // negative before a plant has begun, infinite after its end
  bool released_ = false;
};

}  // namespace trackbed
