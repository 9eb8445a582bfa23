#include "trackbed/recording/record_clocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/recording/signal_delay.h"

namespace trackbed {

std::vector<std::string> ClockNotes(const RecordedDrive& drive) {
  const std::vector<RecordedSample>& samples = drive.samples;
  std::vector<double> speed;
  std::vector<double> yaw_rate;
  std::vector<double> pose_speed;
  std::vector<double> pose_yaw_rate;
  std::vector<bool> valid;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const Pose2& before = samples[i - 1].pose;
    const Pose2& after = samples[i + 1].pose;
    const double time = 2.0 * drive.period;
    speed.push_back(samples[i].velocity_V.x());
    yaw_rate.push_back(samples[i].yaw_rate);
    pose_speed.push_back(
        (after.position() - before.position()).dot(Direction(samples[i].pose.yaw)) / time);
    pose_yaw_rate.push_back((after.yaw - before.yaw) / time);
    valid.push_back(samples[i - 1].valid && samples[i].valid && samples[i + 1].valid);
  }
  std::vector<std::string> notes;
  const auto compare = [&](const char* name, const std::vector<double>& reference,
                           const std::vector<double>& signal) {
    const auto found = FindDelay(reference, signal, valid, drive.period);
    if (!found) {
      return;
    }
    if (std::abs(found->delay) > std::max(3.0 * found->standard_error, drive.period)) {
      notes.push_back(fmt::format(
          "{} {} the motion of the pose by {:.3g} s (standard error {:.2g} s)", name,
          found->delay > 0.0 ? "lags" : "precedes", std::abs(found->delay), found->standard_error));
    }
  };
  compare("speed", pose_speed, speed);
  compare("yaw_rate", pose_yaw_rate, yaw_rate);
  return notes;
}

}  // namespace trackbed
