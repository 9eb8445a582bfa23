#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

/// The clock of a run that is watched.
namespace trackbed {

/// How far a simulation may have come at a moment of the wall clock. All times are in seconds.
class Pace {
 public:
  /// `speed` is simulated over wall time, > 0, or infinity for as fast as possible.
  Pace(double speed, bool paused) : speed_(speed), paused_(paused) {}

  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] bool paused() const { return paused_; }

  /// The simulated time that may be reached at `wall`; infinite at infinite speed.
  [[nodiscard]] double AllowedAt(double wall) const;
  /// The moment at which `simulated` may be reached; infinite when it is not before something else
  /// changes.
  [[nodiscard]] double MomentOf(double simulated) const;

  // Of a simulation that has come to `simulated` at `wall`.

  void Pause(double simulated);
  void Resume(double simulated, double wall);
  /// Pauses, and lets the simulation go on by `period` from where it is, or is going to.
  void Step(double simulated, double period);
  void SetSpeed(double speed, double simulated, double wall);
  /// Time that a slow simulation has lost is not made up for: speeds count from here.
  void KeepUp(double simulated, double wall);

 private:
  void CountFrom(double simulated, double wall);

  double speed_;
  bool paused_;
  double until_ = 0.0;           // where a pause holds
  double from_simulated_ = 0.0;  // where and when the speed counts from
  double from_wall_ = 0.0;
};

/// Lets the plants of a run, each in a thread of its own, go on at one pace: none begins a control
/// period before all others have come as far. Every function may be called by any thread.
class DriveClock {
 public:
  /// `period` is the control period [s].
  DriveClock(std::size_t plants, double period, double speed, bool paused);

  /// A plant has come to `time` [s]; returns when it may simulate the next control period.
  void Advance(std::size_t plant, double time);
  /// A plant takes no more part.
  void End(std::size_t plant);
  /// Nobody waits any more.
  void Release();

  void Pause();
  void Resume();
  /// Pauses; all plants simulate one control period.
  void Step();
  /// As Pace.
  void SetSpeed(double speed);

  struct State {
    bool paused = false;
    double speed = 1.0;
  };
  [[nodiscard]] State state() const;

 private:
  [[nodiscard]] double SlowestTime() const;  // of the plants that take part [s]
  [[nodiscard]] double Reached() const;      // by all of them [s]; 0 before they have begun
  [[nodiscard]] double Now() const;          // wall clock [s]

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double period_;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  Pace pace_;
  std::vector<double> times_;  // negative before a plant has begun, infinite when it has ended
  bool released_ = false;
};

}  // namespace trackbed
