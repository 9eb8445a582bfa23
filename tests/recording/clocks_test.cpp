#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/recording/import_log.h"
#include "trackbed/recording/record_clocks.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/scene.h"

// Tests the delays that ImportLog finds, on simulated drives whose signals are logged with known
// delays, rates and noise.
namespace trackbed {
namespace clocks_test {

constexpr double kStep = 0.01;      // [s]
constexpr double kDuration = 45.0;  // [s]

/// Delays of the logged signals, by their names in notes [s].
using Delays = std::map<std::string, double>;

/// The motion of the rear axle at times that are kStep apart.
struct Drive {
  std::vector<Pose2> pose;
  std::map<std::string, std::vector<double>> signals;

  [[nodiscard]] double At(const std::string& signal, double time) const {
    const std::vector<double>& values = signals.at(signal);
    const double place = std::clamp(time / kStep, 0.0, static_cast<double>(values.size() - 2));
    const auto before = static_cast<std::size_t>(place);
    return std::lerp(values[before], values[before + 1], place - static_cast<double>(before));
  }
};

/// Simulates the Prius as a single-track car with a random speed and steering, each a sum of sines.
Drive Simulate(std::mt19937& random, const CarModel& car) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::array<std::array<double, 3>, 6> steering{};  // amplitude, frequency, phase
  std::array<std::array<double, 3>, 4> throttle{};
  for (auto& wave : steering) {
    wave = {0.01 + 0.02 * uniform(random), 0.3 + 2.7 * uniform(random), 6.28 * uniform(random)};
  }
  for (auto& wave : throttle) {
    wave = {0.1 + 0.3 * uniform(random), 0.6 + 1.5 * uniform(random), 6.28 * uniform(random)};
  }
  const auto sum = [](const auto& waves, double t) {
    double value = 0.0;
    for (const auto& [amplitude, frequency, phase] : waves) {
      value += amplitude * std::sin(frequency * t + phase);
    }
    return value;
  };
  const World world;
  const auto plant =
      MakePlant("single_track", {.car = car, .world = world, .start = {.speed = 12.0}});
  Drive drive;
  const double l = car.params().cg_to_rear;
  std::vector<double> across;  // lateral speed of the rear axle
  for (double t = 0.0; t < kDuration; t += kStep) {
    const Command command{.steering = sum(steering, t), .acceleration = sum(throttle, t)};
    for (int k = 0; k < std::lround(kStep / car.timestep()); ++k) {
      plant->Step(command);
    }
    const VehicleState state = plant->Observe();
    drive.pose.push_back(state.pose);
    drive.signals["speed"].push_back(state.speed);
    drive.signals["yaw_rate"].push_back(state.yaw_rate);
    across.push_back(state.lateral_speed - l * state.yaw_rate);
  }
  const std::vector<double>& speed = drive.signals["speed"];
  const std::vector<double>& yaw_rate = drive.signals["yaw_rate"];
  for (std::size_t i = 0; i < speed.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, speed.size() - 1);
    const double time = kStep * static_cast<double>(after - before);
    drive.signals["accelerometer.x"].push_back((speed[after] - speed[before]) / time -
                                               across[i] * yaw_rate[i]);
    drive.signals["accelerometer.y"].push_back((across[after] - across[before]) / time +
                                               speed[i] * yaw_rate[i]);
  }
  return drive;
}

/// Writes the drive as a log with its signals in a second file of another rate, and returns the
/// notes of the import.
std::vector<std::string> ImportNotes(const Drive& drive, const Delays& delays, std::mt19937& random,
                                     bool align = false) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  const double pose_rate = std::array{20.0, 50.0, 100.0}[random() % 3];
  const double signal_rate = std::array{25.0, 50.0, 130.0}[random() % 3];
  const double noise = 0.2 + 0.8 * uniform(random);
  const TempFolder folder;
  std::string log = "t,x,y,yaw\n";
  const double end = kDuration - 2.0 * kStep;
  for (double t = 1.0; t < end - 1.0; t += 1.0 / pose_rate) {
    const Pose2& pose = drive.pose[static_cast<std::size_t>(std::lround(t / kStep))];
    const double at = kStep * static_cast<double>(std::lround(t / kStep));
    log += fmt::format("{},{},{},{}\n", at, pose.x + 0.005 * noise * normal(random),
                       pose.y + 0.005 * noise * normal(random),
                       pose.yaw + 0.003 * noise * normal(random));
  }
  const std::vector<std::pair<std::string, double>> columns{
      {"speed", 0.02}, {"yaw_rate", 0.01}, {"accelerometer.x", 0.1}, {"accelerometer.y", 0.1}};
  std::string others = "t,v,r,ax,ay\n";
  for (double t = 1.0; t < end - 1.0; t += 1.0 / signal_rate) {
    others += fmt::format("{}", t);
    for (const auto& [name, deviation] : columns) {
      const double delay = delays.contains(name) ? delays.at(name) : 0.0;
      others += fmt::format(",{}", drive.At(name, t - delay) + deviation * noise * normal(random));
    }
    others += "\n";
  }
  const auto file = folder.Write("log.csv", log);
  folder.Write("signals.csv", others);
  LogMap map{.name = "map"};
  map.time.column = "t";
  map.position = {.x = "x", .y = "y"};
  map.yaw.emplace();
  map.yaw->column = "yaw";
  map.speed.emplace();
  map.speed->column = "v";
  map.speed->file = "signals.csv";
  map.yaw_rate.emplace();
  map.yaw_rate->column = "r";
  map.yaw_rate->file = "signals.csv";
  map.accelerometer = LogAccelerometer{.x = "ax", .y = "ay", .file = "signals.csv"};
  map.align = align;
  map.check = false;  // at 20 Hz, the noise of the positions exceeds the turns
  const RecordedDrive imported = ImportLog(file, map);
  std::vector<std::string> notes = imported.notes;
  for (const std::string& note : ClockNotes(imported)) {
    notes.push_back("record: " + note);
  }
  return notes;
}

/// Delay and standard error that a note states [s].
struct Noted {
  double delay = 0.0;
  double error = 0.0;
};

std::map<std::string, Noted> NotedDelays(const std::vector<std::string>& notes) {
  const std::regex pattern(
      "([a-z_.]+) (lags|precedes) the motion of the pose by ([0-9.e-]+) s "
      "\\(standard error ([0-9.e-]+) s\\).*");
  std::map<std::string, Noted> found;
  for (const std::string& note : notes) {
    std::smatch match;
    if (std::regex_match(note, match, pattern)) {
      const double sign = match[2] == "lags" ? 1.0 : -1.0;
      found[match[1]] = {sign * std::stod(match[3]), std::stod(match[4])};
    }
  }
  return found;
}

TEST(Clocks, AreFoundInRandomDrives) {
  const CarModel car(ComposeScene(FindModel("prius", "."), {}), "prius");
  const std::vector<const char*> names{"speed", "yaw_rate", "accelerometer.x", "accelerometer.y"};
  int delayed = 0;
  int wrong = 0;
  for (unsigned seed = 1; seed <= 16; ++seed) {
    std::mt19937 random(seed);
    const Drive drive = Simulate(random, car);
    std::uniform_real_distribution<double> size(0.15, 0.6);
    Delays delays;
    for (const char* name : names) {
      if (random() % 2 == 0) {
        delays[name] = (random() % 4 == 0 ? -1.0 : 1.0) * size(random);
      }
    }
    const std::map<std::string, Noted> noted = NotedDelays(ImportNotes(drive, delays, random));
    for (const char* name : names) {
      if (!delays.contains(name)) {
        EXPECT_FALSE(noted.contains(name)) << "drive " << seed << ": " << name;
        continue;
      }
      ++delayed;
      // Notes state three digits, so that the delay is rounded by up to 0.0005 s.
      const bool right = noted.contains(name) && std::abs(noted.at(name).delay - delays.at(name)) <
                                                     3.0 * noted.at(name).error + Tolerance(0.0005);
      wrong += right ? 0 : 1;
    }
  }
  // Of normal errors, 0.3 % exceed three standard errors. Of the 30 delays, one may do so, or be
  // hidden by noise, with a probability of 0.4 % for a second one if 0.4 % of the delays do.
  EXPECT_GT(delayed, 20);
  EXPECT_LE(wrong, 1);
}

TEST(Clocks, AgreeAfterAlignment) {
  const CarModel car(ComposeScene(FindModel("prius", "."), {}), "prius");
  std::mt19937 random(7);
  const Drive drive = Simulate(random, car);
  const Delays delays{{"speed", 0.2}, {"yaw_rate", 0.36}, {"accelerometer.y", -0.15}};
  std::mt19937 same = random;
  const std::vector<std::string> unaligned = ImportNotes(drive, delays, random);
  // Signals that are not aligned are found in the imported drive, too.
  EXPECT_THAT(unaligned, testing::Contains(testing::StartsWith("record: yaw_rate lags")));
  EXPECT_THAT(unaligned, testing::Contains(testing::StartsWith("record: speed lags")));
  const std::vector<std::string> aligned = ImportNotes(drive, delays, same, /*align=*/true);
  EXPECT_THAT(aligned, testing::Contains(testing::EndsWith(": shifted by this delay")).Times(3));
  EXPECT_THAT(aligned, testing::Not(testing::Contains(testing::StartsWith("record: "))));
}

}  // namespace clocks_test
}  // namespace trackbed
