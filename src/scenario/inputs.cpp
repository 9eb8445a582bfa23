#include "src/scenario/inputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "src/scenario/route_world.h"
#include "trackbed/control/playback.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/path_files/path_file.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/recording/import_log.h"
#include "trackbed/recording/record_csv.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/scenario/recording_file.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/scene.h"
#include "trackbed/track/track_file.h"

// Reads the files that a scenario names, in this order: record, track, map, road network,
// recording, path. Each reader first checks that its keys were read and that the file may be read:
// it must lie in the scenario's folder, in an asset folder or, except for recordings, in Trackbed's
// data folder. Attempt separates problems inside a file, which are returned with their position
// there, from problems of a key, which are reported at the key.
namespace trackbed {
namespace {

/// Calls `read`. Returns the problems inside a file; reports the problems of a key by `add_error`.
std::vector<Problem> Attempt(const std::function<void()>& read, const char* key,
                             ReaderContext& context, const AddKeyError& add_error) {
  try {
    read();
  } catch (const InputError& error) {
    if (!error.problems().front().file.empty()) {
      context.unread.emplace_back(key);
      return error.problems();
    }
    for (const Problem& problem : error.problems()) {
      add_error(problem.key.empty() ? key : problem.key, problem.message);
    }
  } catch (const RunError& error) {
    add_error(key, error.what());
  }
  return {};
}

/// Adds Trackbed's data folder to the folders that may be read.
std::vector<std::filesystem::path> WithOwnData(std::vector<std::filesystem::path> folders) {
  try {
    folders.push_back(DataFolder());
  } catch (const InputError&) {
    // This installation has no data folder.
  }
  return folders;
}

RecordedDrive ReadRecord(const Scenario& scenario, const std::optional<LogMap>& given) {
  const RecordSpec& record = *scenario.record;
  const std::filesystem::path file = scenario.folder / record.file;
  if (!given) {
    RecordedDrive drive = ReadRecordCsv(file);
    if (record.notes) {
      drive.notes.clear();
      std::istringstream lines(*record.notes);
      for (std::string line; std::getline(lines, line);) {
        drive.notes.push_back(line);
      }
    }
    return drive;
  }
  LogMap map = *given;
  map.from = record.from.value_or(map.from);
  map.to = record.to ? record.to : map.to;
  return ImportLog(file, map);
}

std::vector<Problem> ReadRecord(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error) {
  RecordSpec& record = *scenario.record;
  const auto may_read = [&](const std::string& name, const char* key) {
    const std::string why =
        WhyUnreadable(name, scenario.folder, WithOwnData(scenario.asset_folders));
    if (!why.empty()) {
      add_error(key, fmt::format("{} {}", name, why));
    }
    return why.empty();
  };
  if (!context.Read("record") || !context.Read("record.file") || !context.Read("record.map") ||
      !context.Read("record.from") || !context.Read("record.to") || record.file.empty() ||
      !may_read(record.file, "record.file") ||
      (record.map && !may_read(*record.map, "record.map"))) {
    return {};
  }
  if (!record.map && (record.from || record.to)) {
    add_error("record.map", "missing; from and to cut a log that is read by a map");
    return {};
  }
  std::optional<LogMap> map;
  if (record.map) {
    const std::vector<Problem> problems = Attempt(
        [&] { map = ReadLogMap(scenario.folder / *record.map); }, "record.map", context, add_error);
    if (!map) {
      return problems;
    }
  }
  return Attempt(
      [&] { record.data = std::make_shared<const RecordedDrive>(ReadRecord(scenario, map)); },
      "record.file", context, add_error);
}

/// Takes the recorded inputs for the controller `playback` and for prediction windows.
std::vector<Problem> TakeInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error) {
  const RecordSpec& record = *scenario.record;
  const std::vector<std::string>& plants = scenario.drive.plants;
  auto* playback = scenario.control.steering.As<PlaybackOptions>();
  const bool replays = playback != nullptr && playback->file.empty();
  if (!record.data || !(replays || !record.windows.empty()) ||
      std::all_of(plants.begin(), plants.end(),
                  [](const std::string& plant) { return plant == kRecordedPlant; })) {
    return {};
  }
  return Attempt(
      [&] {
        const Recording inputs = ReplayInputs(*record.data, record.steering, record.drive);
        if (replays) {
          playback->recording = inputs;
        }
      },
      "record", context, add_error);
}

std::vector<Problem> ReadPlayback(Scenario& scenario, PlaybackOptions& playback,
                                  ReaderContext& context, const AddKeyError& add_error) {
  if (!context.Read("control.file") || !context.Read("control.columns")) {
    return {};
  }
  if (playback.file.empty()) {
    if (!scenario.record) {
      add_error("control.file", "missing");
    } else if (playback.by == PlaybackAxis::kDistance) {
      add_error("control.by", "a record is replayed over time; remove this");
    }
    return {};
  }
  if (const std::string why = WhyUnreadable(playback.file, scenario.folder, scenario.asset_folders);
      !why.empty()) {
    add_error("control.file", fmt::format("{} {}", playback.file, why));
    return {};
  }
  return Attempt(
      [&] {
        playback.recording =
            ReadRecording(scenario.folder / playback.file, playback.by, playback.columns);
      },
      "control.file", context, add_error);
}

/// Keys are prefixed by the planner's section, as in "plan.file".
std::vector<Problem> ReadPath(Scenario& scenario, PathFileOptions& options, ReaderContext& context,
                              const AddKeyError& add_error) {
  const bool layers = scenario.plan->avoid || scenario.plan->replan;
  const std::string section = layers ? "plan.global." : "plan.";
  const std::string file_key = section + "file";
  const std::vector<std::pair<std::string, std::string>> wrong = PathMapProblems(options.map);
  for (const auto& [key, message] : wrong) {
    add_error(section + key, message);
  }
  if (!wrong.empty() || options.file.empty() || !context.Read(section + "max_deviation") ||
      !context.Read(section + "resample") || !context.Read(section + "columns") ||
      !context.Read(file_key)) {
    return {};
  }
  if (const std::string why =
          WhyUnreadable(options.file, scenario.folder, WithOwnData(scenario.asset_folders));
      !why.empty()) {
    add_error(file_key, fmt::format("{} {}", options.file, why));
    return {};
  }
  const std::filesystem::path file = scenario.folder / options.file;
  return Attempt(
      [&] {
        PathFile found = ReadPathFile(file, options.map);
        if (!options.notes) {
          options.notes = fmt::format("{}", fmt::join(found.notes, "\n"));
        }
        try {
          options.path = std::make_shared<const FittedPath>(
              FitPath(AtRearAxle(std::move(found.points), options.ahead), options.fit));
        } catch (const InputError& error) {
          std::vector<Problem> problems = error.problems();
          for (Problem& problem : problems) {
            if (problem.key.empty()) {
              problem.file = file.string();
            } else {
              problem.key = section + problem.key;
            }
          }
          throw InputError(std::move(problems));
        }
      },
      file_key.c_str(), context, add_error);
}

std::vector<Problem> ReadTrackFile(Scenario& scenario, ReaderContext& context,
                                   const AddKeyError& add_error) {
  TrackSpec& track = *scenario.mission.track;
  const char* key = "mission.track.file";
  if (!context.Read("mission.track") || !context.Read(key) ||
      !context.Read("mission.track.smoothing") || track.file.empty()) {
    return {};
  }
  if (const std::string why =
          WhyUnreadable(track.file, scenario.folder, WithOwnData(scenario.asset_folders));
      !why.empty()) {
    add_error(key, fmt::format("{} {}", track.file, why));
    return {};
  }
  return Attempt(
      [&] {
        track.data =
            std::make_shared<const Track>(ReadTrack(scenario.folder / track.file, track.smoothing));
      },
      key, context, add_error);
}

std::vector<Problem> ReadMap(Scenario& scenario, MapSpec& map, ReaderContext& context,
                             const AddKeyError& add_error) {
  if (!context.Read("world.map") || !context.Read("world.map.file") ||
      !context.Read("world.map.cell") || map.file.empty()) {
    return {};
  }
  const std::vector<std::filesystem::path> others = WithOwnData(scenario.asset_folders);
  if (const std::string why = WhyUnreadable(map.file, scenario.folder, others); !why.empty()) {
    add_error("world.map.file", fmt::format("{} {}", map.file, why));
    return {};
  }
  const std::filesystem::path own = (scenario.folder / map.file).parent_path();
  const WhyNot why_not = [&](const std::filesystem::path& image) {
    return WhyUnreadableImage(image, own, others);
  };
  return Attempt(
      [&] {
        map.data = std::make_shared<const MapObstacles>(ReadMap(map, scenario.folder, why_not));
      },
      "world.map.file", context, add_error);
}

/// Uses the elevation of the roads on the mission's route as ground.
void LayRouteGround(Scenario& scenario, const AddKeyError& add_error) {
  const bool has_ground = !IsFlat(scenario.world.ground);
  const std::string failure = AddRouteGround(scenario.mission.route, scenario.world);
  if (!failure.empty()) {
    add_error("mission.route", failure);
  } else if (has_ground && scenario.world.ground.terrain) {
    add_error("world.ground",
              "not available on a route over roads that are not level, whose heights are the "
              "ground; remove it");
  }
}

std::vector<Problem> ReadRoads(Scenario& scenario, RoadNetworkSpec& roads, ReaderContext& context,
                               const AddKeyError& add_error) {
  const char* key = "world.road_network";
  if (!context.Read(key)) {
    return {};
  }
  if (const std::string why =
          WhyUnreadable(roads.file, scenario.folder, WithOwnData(scenario.asset_folders));
      !why.empty()) {
    add_error(key, fmt::format("{} {}", roads.file, why));
    return {};
  }
  return Attempt(
      [&] {
        roads.data =
            std::make_shared<const OpenDriveFile>(ReadOpenDriveFile(scenario.folder / roads.file));
        // After an error the route may differ from the intended one.
        if (context.problems.empty()) {
          LayRouteGround(scenario, add_error);
        }
      },
      key, context, add_error);
}

}  // namespace

std::string WhyUnreadableImage(const std::filesystem::path& image,
                               const std::filesystem::path& folder,
                               const std::vector<std::filesystem::path>& others) {
  // Uses absolute paths: lexically_relative returns nothing for a relative and an absolute path.
  const std::filesystem::path from = std::filesystem::absolute(folder / ".").lexically_normal();
  const std::filesystem::path to = std::filesystem::absolute(image).lexically_normal();
  return WhyUnreadable(to.lexically_relative(from).string(), folder, others);
}

std::vector<Problem> ReadInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error) {
  std::vector<Problem> problems;
  const auto add = [&](const std::vector<Problem>& more) {
    problems.insert(problems.end(), more.begin(), more.end());
  };
  if (scenario.record) {
    add(ReadRecord(scenario, context, add_error));
    if (!scenario.record->data) {
      context.unread.emplace_back("record");
    }
    add(TakeInputs(scenario, context, add_error));
  }
  if (scenario.mission.track) {
    add(ReadTrackFile(scenario, context, add_error));
  }
  if (auto& map = scenario.world.map) {
    add(ReadMap(scenario, *map, context, add_error));
    if (!map->data) {
      context.unread.emplace_back("world.map");
    }
  }
  if (auto& roads = scenario.world.road_network) {
    add(ReadRoads(scenario, *roads, context, add_error));
    if (!roads->data) {
      context.unread.emplace_back("world.road_network");
    }
  }
  if (auto* playback = scenario.control.steering.As<PlaybackOptions>()) {
    add(ReadPlayback(scenario, *playback, context, add_error));
  }
  if (auto* path = scenario.plan ? scenario.plan->global.As<PathFileOptions>() : nullptr) {
    add(ReadPath(scenario, *path, context, add_error));
  }
  return problems;
}

}  // namespace trackbed
