#include "src/watch/drive_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trackbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

double Pace::AllowedAt(double wall) const {
  if (paused_) {
    return until_;
  }
  return std::isinf(speed_) ? kInfinity : from_simulated_ + speed_ * (wall - from_wall_);
}

double Pace::MomentOf(double simulated) const {
  if (paused_) {
    return simulated <= until_ ? -kInfinity : kInfinity;
  }
  return std::isinf(speed_) ? -kInfinity : from_wall_ + (simulated - from_simulated_) / speed_;
}

void Pace::Pause(double simulated) {
  if (!paused_) {
    paused_ = true;
    until_ = simulated;
  }
}

void Pace::Resume(double simulated, double wall) {
  if (paused_) {
    paused_ = false;
    CountFrom(simulated, wall);
  }
}

void Pace::Step(double simulated, double period) {
  Pause(simulated);
  until_ = std::max(until_, simulated) + period;
}

void Pace::SetSpeed(double speed, double simulated, double wall) {
  speed_ = speed;
  CountFrom(simulated, wall);
}

void Pace::KeepUp(double simulated, double wall) {
  // longest lag behind the wall clock for which the simulation catches up later [s]; the scheduler
  // causes such small lags
  constexpr double kMaxLag = 0.1;
  if (!paused_ && !std::isinf(speed_) && AllowedAt(wall) - simulated > kMaxLag * speed_) {
    CountFrom(simulated, wall);
  }
}

void Pace::CountFrom(double simulated, double wall) {
  from_simulated_ = simulated;
  from_wall_ = wall;
}

DriveClock::DriveClock(std::size_t plants, double period, double speed, bool paused)
    : period_(period), pace_(speed, paused), times_(plants, -period) {}

void DriveClock::Advance(std::size_t plant, double time) {
  std::unique_lock lock(mutex_);
  times_[plant] = time;
  if (SlowestTime() == time) {
    pace_.KeepUp(time, Now());
  }
  changed_.notify_all();
  const double next = time + period_;
  // tolerance for comparing times, which are rounded sums of periods
  const double tolerance = 0.5 * period_;
  while (!released_) {
    const bool others_arrived = SlowestTime() > time - tolerance;
    // If one plant has begun a control period, all plants simulate this period, even if a pause
    // begins meanwhile.
    const bool begun = begun_ > next - tolerance;
    const double wait = begun ? 0.0 : pace_.MomentOf(next - tolerance) - Now();
    if (others_arrived && wait <= 0.0) {
      begun_ = std::max(begun_, next);
      return;
    }
    if (others_arrived && std::isfinite(wait)) {
      changed_.wait_for(lock, std::chrono::duration<double>(wait));
    } else {
      changed_.wait(lock);
    }
  }
}

void DriveClock::End(std::size_t plant) {
  const std::lock_guard lock(mutex_);
  times_[plant] = kInfinity;
  changed_.notify_all();
}

void DriveClock::Release() {
  const std::lock_guard lock(mutex_);
  released_ = true;
  changed_.notify_all();
}

void DriveClock::Pause() {
  const std::lock_guard lock(mutex_);
  pace_.Pause(begun_);
  changed_.notify_all();
}

void DriveClock::Resume() {
  const std::lock_guard lock(mutex_);
  pace_.Resume(begun_, Now());
  changed_.notify_all();
}

void DriveClock::Step() {
  const std::lock_guard lock(mutex_);
  pace_.Step(begun_, period_);
  changed_.notify_all();
}

void DriveClock::SetSpeed(double speed) {
  const std::lock_guard lock(mutex_);
  pace_.SetSpeed(speed, begun_, Now());
  changed_.notify_all();
}

DriveClock::State DriveClock::state() const {
  const std::lock_guard lock(mutex_);
  return {pace_.paused(), pace_.speed()};
}

double DriveClock::SlowestTime() const {
  return *std::min_element(times_.begin(), times_.end());
}

double DriveClock::Now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace trackbed
