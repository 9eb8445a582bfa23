#include "render/events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace trackbed::render {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

Point PlaceOf(const Recording& recording, double time) {
  return recording.OnGround(recording.plants.front().Position(time));
}

OrientedBox CarFootprint(const Recording& recording, const CarBox& box, double time) {
  const PlantRecording& car = recording.plants.front();
  const Point place = car.Position(time);
  const Pose2 rear{place.x, place.y, car.Heading(time)};
  const Vec2 middle = ToWorld(rear, {box.middle, 0.0});
  return {{middle.x(), middle.y(), rear.yaw}, 2.0 * box.half_length, 2.0 * box.half_width};
}

void AddObstaclesKnown(const Recording& recording, std::vector<RunEvent>& events) {
  const std::vector<double> known = KnownFrom(recording);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (std::isfinite(known[i])) {
      events.push_back({.kind = RunEvent::Kind::kObstacleKnown,
                        .from = known[i],
                        .to = known[i],
                        .place = PlaceOf(recording, known[i]),
                        .text = "obstacle detected",
                        .obstacle = static_cast<int>(i)});
    }
  }
}

void AddNewPlans(const Recording& recording, std::vector<RunEvent>& events) {
  int count = 0;
  for (const NewPlan& plan : recording.new_plans) {
    events.push_back({.kind = RunEvent::Kind::kNewPlan,
                      .from = plan.from,
                      .to = plan.from,
                      .place = PlaceOf(recording, plan.from),
                      .text = fmt::format("new plan {}", ++count)});
  }
}

void AddRateLimits(const Recording& recording, std::vector<RunEvent>& events) {
  const TimedTable& log = recording.plants.front().log();
  const std::optional<std::size_t> actuator = log.Find("steering_actuator_rad");
  if (!actuator || recording.steering_rate <= 0.0) {
    return;
  }
  // Fraction of the maximum steering rate above which the steering counts as being at the rate
  // limit, because the log is rounded.
  constexpr double kShare = 0.98;
  // Tolerance within which the steering counts as having reached its command [rad].
  constexpr double kReached = 1e-6;
  // Maximum gap between two periods at the rate limit that count as one event [s].
  constexpr double kSameEvent = 0.5;
  const std::size_t command = log.Require("steering_command_rad");
  const std::vector<double>& times = log.times();
  const Table& rows = log.table();
  std::optional<RunEvent> event;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double turned = rows.at(i + 1, *actuator) - rows.at(i, *actuator);
    const double left = rows.at(i, command) - rows.at(i + 1, *actuator);
    const double rate = std::abs(turned) / (times[i + 1] - times[i]);
    if (rate < kShare * recording.steering_rate || std::abs(left) <= kReached) {
      continue;
    }
    if (event && times[i] - event->to < kSameEvent) {
      event->to = times[i + 1];
      continue;
    }
    if (event) {
      events.push_back(*event);
    }
    event = RunEvent{.kind = RunEvent::Kind::kRateLimit,
                     .from = times[i],
                     .to = times[i + 1],
                     .place = PlaceOf(recording, times[i]),
                     .text = "steering rate limit"};
  }
  if (event) {
    events.push_back(*event);
  }
}

void AddCollision(const Recording& recording, std::vector<RunEvent>& events) {
  if (recording.contact_time) {
    events.push_back({.kind = RunEvent::Kind::kCollision,
                      .from = *recording.contact_time,
                      .to = kNever,
                      .place = PlaceOf(recording, *recording.contact_time),
                      .text = fmt::format("collision at {:.2f} s", *recording.contact_time)});
  }
}

void AddRollOver(const Recording& recording, std::vector<RunEvent>& events) {
  // Cosine of the lean angle at which a run ends with the status rolled_over, 60 degrees.
  constexpr double kRolledOverCosine = 0.5;
  // Cosine of the lean angle at which a roll-over event begins, 30 degrees.
  constexpr double kLeaningCosine = 0.87;
  const PlantRecording& car = recording.plants.front();
  const std::vector<double>& times = car.times();
  const auto first = std::find_if(times.begin(), times.end(),
                                  [&](double at) { return car.Upright(at) < kRolledOverCosine; });
  if (first == times.end() && !recording.roll_over_time) {
    return;
  }
  const double over = recording.roll_over_time.value_or(first == times.end() ? 0.0 : *first);
  // The last recorded state may be earlier than the roll-over time `over`, because states are
  // recorded less often than rows of the log.
  auto from = std::upper_bound(times.begin(), times.end(), over);
  while (from != times.begin() && car.Upright(*(from - 1)) < kLeaningCosine) {
    --from;
  }
  if (from == times.end()) {
    --from;
  }
  events.push_back({.kind = RunEvent::Kind::kRollOver,
                    .from = *from,
                    .to = kNever,
                    .place = PlaceOf(recording, *from),
                    .text = fmt::format("roll-over at {:.2f} s", over)});
}

}  // namespace

std::vector<double> KnownFrom(const Recording& recording) {
  const std::vector<double>& times = recording.plants.front().log().times();
  const CarBox box = FindCarBox(*recording.model);
  std::vector<double> known;
  for (const Obstacle& obstacle : recording.world.obstacles) {
    const auto is_known = [&](double time) {
      return IsKnown(obstacle, time, CarFootprint(recording, box, time));
    };
    const auto first = !obstacle.known_from_time && !obstacle.known_from_range
                           ? times.begin()
                           : std::find_if(times.begin(), times.end(), is_known);
    known.push_back(first == times.begin() ? -kNever : first == times.end() ? kNever : *first);
  }
  return known;
}

std::vector<RunEvent> FindEvents(const Recording& recording) {
  std::vector<RunEvent> events;
  AddObstaclesKnown(recording, events);
  AddNewPlans(recording, events);
  AddRateLimits(recording, events);
  AddCollision(recording, events);
  AddRollOver(recording, events);
  std::stable_sort(events.begin(), events.end(),
                   [](const RunEvent& a, const RunEvent& b) { return a.from < b.from; });
  return events;
}

}  // namespace trackbed::render
