#include "src/watch/live_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/watch/watch.h"

namespace trackbed {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::array kAdded{"rows", "poses", "plans"};
enum Added : std::size_t { kRows, kPoses, kPlans };

std::string SpeedText(double speed) {
  return std::isinf(speed) ? "\"max\"" : fmt::format("{}", speed);
}

}  // namespace

LiveRun::LiveRun(const ordered_json& first, std::string id, double control_period, double speed,
                 bool paused)
    : id_(std::move(id)),
      clock_(first.at("runs").at(0).at("plants").size(), control_period, speed, paused) {
  for (const ordered_json& plant : first.at("runs").at(0).at("plants")) {
    plants_.push_back({plant.at("name").get<std::string>(), LiveRows(plant)});
  }
}

DriveHooks LiveRun::HooksOf(const std::string& plant) {
  const std::size_t index = IndexOf(plant);
  return {.interrupted =
              [this] {
                const std::lock_guard lock(mutex_);
                return interrupted_;
              },
          .logged =
              [this, index](const RunLog& log, const Table& configurations) {
                Add(index, log, configurations);
                clock_.Advance(index, log.rows.back().state.time);
              }};
}

void LiveRun::EndOf(const std::string& plant) {
  clock_.End(IndexOf(plant));
}

void LiveRun::Interrupt() {
  {
    const std::lock_guard lock(mutex_);
    interrupted_ = true;
  }
  clock_.Release();
}

void LiveRun::Finish() {
  const std::lock_guard lock(mutex_);
  finished_ = true;
}

std::size_t LiveRun::IndexOf(const std::string& plant) const {
  const auto found = std::find_if(plants_.begin(), plants_.end(),
                                  [&](const Plant& one) { return one.name == plant; });
  TRACKBED_CHECK(found != plants_.end(), "no plant '{}'", plant);
  return static_cast<std::size_t>(found - plants_.begin());
}

void LiveRun::Add(std::size_t index, const RunLog& log, const Table& configurations) {
  // Time between two poses of the replay [s], as in reports.
  constexpr double kPosePeriod = 1.0 / 30.0;
  constexpr double kRounding = 1e-6;  // Tolerance for rounding errors of times [s].
  const std::lock_guard lock(mutex_);
  Plant& plant = plants_[index];
  plant.added[kRows].push_back(plant.text.LastRow(log));
  for (; plant.configurations_seen < configurations.rows(); ++plant.configurations_seen) {
    const double time = configurations.at(plant.configurations_seen, 0);
    std::string pose = time + kRounding < plant.next_pose
                           ? ""
                           : plant.text.Pose(configurations, plant.configurations_seen);
    if (!pose.empty()) {
      plant.added[kPoses].push_back(std::move(pose));
      plant.next_pose = kPosePeriod * (std::floor((time + kRounding) / kPosePeriod) + 1.0);
    }
  }
  for (; plant.changes_seen < log.changes.size(); ++plant.changes_seen) {
    plant.added[kPlans].push_back(LiveRows::NewPlan(log.changes[plant.changes_seen]));
  }
}

std::optional<std::string> LiveRun::Next(Cursor& cursor) const {
  std::string state = StateText();
  if (state != cursor.state) {
    cursor.state = state;
    return state;
  }
  const std::lock_guard lock(mutex_);
  if (std::optional<std::string> rows = RowsText(cursor)) {
    return rows;
  }
  if (finished_ && !cursor.finished) {
    cursor.finished = true;
    return R"({"type":"finished"})";
  }
  return std::nullopt;
}

std::string LiveRun::StateText() const {
  const DriveClock::State state = clock_.state();
  return fmt::format(R"({{"type":"state","id":"{}","paused":{},"speed":{}}})", id_, state.paused,
                     SpeedText(state.speed));
}

std::optional<std::string> LiveRun::RowsText(Cursor& cursor) const {
  // approximate limit of the size of a message [bytes]; one row of each kind and plant may exceed
  // the limit
  constexpr std::size_t kMessage = 80000;
  const std::size_t most = kMessage / (kAdded.size() * plants_.size());
  cursor.places.resize(plants_.size());
  bool any = false;
  std::string text = R"({"type":"rows","plants":[)";
  for (std::size_t i = 0; i < plants_.size(); ++i) {
    std::array<std::size_t, 3>& places = cursor.places[i];
    text += fmt::format(R"({}{{"first":[{}])", i > 0 ? "," : "", fmt::join(places, ","));
    for (std::size_t kind = 0; kind < kAdded.size(); ++kind) {
      const std::vector<std::string>& all = plants_[i].added[kind];
      text += fmt::format(R"(,"{}":[)", kAdded[kind]);
      const std::size_t begin = places[kind];
      for (std::size_t size = 0; places[kind] < all.size() && size < most; ++places[kind]) {
        text += (places[kind] > begin ? "," : "") + all[places[kind]];
        size += all[places[kind]].size();
        any = true;
      }
      text += "]";
    }
    text += "}";
  }
  text += "]}";
  return any ? std::optional(text) : std::nullopt;
}

std::string LiveRun::Execute(std::string_view message) {
  const json command = json::parse(message, nullptr, false);
  if (command.is_discarded() || !command.is_object() || !command.contains("do") ||
      !command["do"].is_string()) {
    return R"(expected an object such as {"do": "pause"})";
  }
  const auto what = command["do"].get<std::string>();
  if (what == "pause") {
    clock_.Pause();
  } else if (what == "resume") {
    clock_.Resume();
  } else if (what == "step") {
    clock_.Step();
  } else if (what == "speed") {
    const json speed = command.value("speed", json());
    const std::optional<double> parsed =
        ParseSpeed(speed.is_string() ? speed.get<std::string>() : speed.dump());
    if (!parsed || (speed.is_string() && speed != "max")) {
      return fmt::format(R"("speed" must be a number from {} to {}, or "max")", kMinPlaybackSpeed,
                         kMaxPlaybackSpeed);
    }
    clock_.SetSpeed(*parsed);
  } else {
    return R"("do" must be "pause", "resume", "step" or "speed")";
  }
  return "";
}

}  // namespace trackbed
