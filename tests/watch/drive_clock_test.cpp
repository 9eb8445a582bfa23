#include "src/watch/drive_clock.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

namespace trackbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPeriod = 0.25;  // [s]; its multiples are exact

TEST(Pace, CountsSimulatedTimeFromTheWallClock) {
  const Pace pace(2.0, false);
  EXPECT_EQ(pace.AllowedAt(3.0), 6.0);
  EXPECT_EQ(pace.MomentOf(6.0), 3.0);
}

TEST(Pace, IsUnlimitedAtInfiniteSpeed) {
  const Pace pace(kInfinity, false);
  EXPECT_EQ(pace.AllowedAt(0.0), kInfinity);
  EXPECT_EQ(pace.MomentOf(1e9), -kInfinity);
}

TEST(Pace, HoldsWhereItIsPaused) {
  Pace pace(1.0, false);
  pace.Pause(2.5);
  EXPECT_EQ(pace.AllowedAt(100.0), 2.5);
  EXPECT_EQ(pace.MomentOf(2.5), -kInfinity);
  EXPECT_EQ(pace.MomentOf(2.75), kInfinity);
  pace.Pause(9.0);  // repeating it changes nothing
  EXPECT_EQ(pace.AllowedAt(100.0), 2.5);
}

TEST(Pace, GoesOnFromWhereItWasPaused) {
  Pace pace(4.0, false);
  pace.Pause(2.0);
  pace.Resume(2.0, 10.0);
  EXPECT_EQ(pace.AllowedAt(11.0), 6.0);
  pace.Resume(2.0, 50.0);  // repeating it changes nothing
  EXPECT_EQ(pace.AllowedAt(11.0), 6.0);
}

TEST(Pace, AddsStepsThatAreAskedForAtOnce) {
  Pace pace(1.0, false);
  pace.Step(2.0, kPeriod);
  EXPECT_TRUE(pace.paused());
  EXPECT_EQ(pace.AllowedAt(100.0), 2.25);
  pace.Step(2.0, kPeriod);
  EXPECT_EQ(pace.AllowedAt(100.0), 2.5);
}

TEST(Pace, ChangesItsSpeedWithoutAJump) {
  Pace pace(1.0, false);
  pace.SetSpeed(10.0, 5.0, 5.0);
  EXPECT_EQ(pace.AllowedAt(5.0), 5.0);
  EXPECT_EQ(pace.AllowedAt(6.0), 15.0);
}

TEST(Pace, DoesNotMakeUpForTimeThatASlowSimulationLost) {
  Pace pace(1.0, false);
  pace.KeepUp(5.0, 5.05);  // the clock catches up the delay of 50 ms
  EXPECT_EQ(pace.AllowedAt(6.0), 6.0);
  pace.KeepUp(5.0, 8.0);
  EXPECT_EQ(pace.AllowedAt(8.0), 5.0);
  EXPECT_EQ(pace.AllowedAt(9.0), 6.0);
}

/// Plants that only query the clock, `periods` times each.
class Plants {
 public:
  Plants(DriveClock& clock, std::size_t count, int periods) : clock_(clock), ticks_(count, -1) {
    for (std::size_t plant = 0; plant < count; ++plant) {
      running_.push_back(std::async(std::launch::async, [this, plant, periods] {
        for (int tick = 0; tick <= periods; ++tick) {
          {
            const std::lock_guard lock(mutex_);
            ticks_[plant] = tick;
            const auto [least, most] = std::minmax_element(ticks_.begin(), ticks_.end());
            spread_ = std::max(spread_, *most - *least);
            changed_.notify_all();
          }
          clock_.Advance(plant, kPeriod * tick);
        }
        clock_.End(plant);
        const std::lock_guard lock(mutex_);
        ticks_[plant] = std::numeric_limits<int>::max() / 2;  // does not take part
      }));
    }
  }

  void WaitFor(int tick) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return *std::min_element(ticks_.begin(), ticks_.end()) >= tick; });
  }
  int Most() {
    const std::lock_guard lock(mutex_);
    return *std::max_element(ticks_.begin(), ticks_.end());
  }
  /// Joins the threads. Returns the largest difference between plants at any time, in periods.
  int Join() {
    for (std::future<void>& plant : running_) {
      plant.get();
    }
    return spread_;
  }

 private:
  DriveClock& clock_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<int> ticks_;
  int spread_ = 0;
  std::vector<std::future<void>> running_;
};

TEST(DriveClock, KeepsPlantsWithinOnePeriod) {
  DriveClock clock(3, kPeriod, kInfinity, false);
  Plants plants(clock, 3, 2000);
  EXPECT_EQ(plants.Join(), 1);
}

TEST(DriveClock, StepsAllPlantsByOnePeriod) {
  DriveClock clock(2, kPeriod, kInfinity, true);
  Plants plants(clock, 2, 1000);
  for (int step = 0; step < 20; ++step) {
    plants.WaitFor(step);
    EXPECT_EQ(plants.Most(), step);  // no plant advances unasked
    clock.Step();
  }
  clock.Release();
  plants.Join();
}

// When the pause begins, one plant has begun a period and the other plant has not yet.
TEST(DriveClock, PausesAllPlantsAtTheSameTime) {
  for (int repetition = 0; repetition < 200; ++repetition) {
    DriveClock clock(2, kPeriod, kInfinity, false);
    std::atomic<bool> comes = false;
    std::future<void> other = std::async(std::launch::async, [&] {
      comes = true;
      clock.Advance(1, 0.0);
    });
    while (!comes) {
      std::this_thread::yield();
    }
    // Now the other plant most probably waits in Advance(). The test also passes if the plant does
    // not wait yet.
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    clock.Advance(0, 0.0);
    clock.Pause();
    const bool begins = other.wait_for(std::chrono::seconds(60)) == std::future_status::ready;
    clock.Release();
    ASSERT_TRUE(begins) << "repetition " << repetition;
  }
}

TEST(DriveClock, LetsPlantsGoOnWhenAnotherHasEnded) {
  DriveClock clock(2, kPeriod, kInfinity, false);
  clock.End(1);
  Plants plants(clock, 1, 100);
  plants.Join();
}

TEST(DriveClock, ReleasesThoseWhoWait) {
  DriveClock clock(2, kPeriod, 1.0, true);
  Plants plants(clock, 2, 100);
  plants.WaitFor(0);
  clock.Release();
  plants.Join();
}

TEST(DriveClock, ResumesAtTheSpeedThatIsSetWhilePaused) {
  DriveClock clock(1, kPeriod, 0.01, true);
  Plants plants(clock, 1, 1000);
  plants.WaitFor(0);
  clock.SetSpeed(kInfinity);
  EXPECT_TRUE(clock.state().paused);
  clock.Resume();
  plants.Join();
  EXPECT_FALSE(clock.state().paused);
  EXPECT_EQ(clock.state().speed, kInfinity);
}

}  // namespace
}  // namespace trackbed
