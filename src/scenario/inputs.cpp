#include "src/scenario/inputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "src/scenario/diagnostics.h"
#include "src/scenario/route_world.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/playback.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/recording/banked_track.h"
#include "trackbed/recording/import_log.h"
#include "trackbed/recording/record_csv.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/scene.h"
#include "trackbed/track/track_file.h"

// Reads the files that a scenario names. The recorded drive, the track, the map and the road
// network are read first, followed by the files of the controller and of the planner. Before
// reading a file, each function checks that the keys with the file name were read and that access
// to the file is allowed. An input file must lie in the scenario's folder or in an asset folder.
// Files other than recordings may also lie in Trackbed's data folder. If a read fails, Attempt()
// returns the problems inside the file with their positions; other problems are reported at the key
// that names the file.
namespace trackbed {
namespace {

/// Calls `read` and catches the errors that `read` throws. Attempt() returns the problems inside
/// the file that `read` reads, and passes problems of the key with the file name to `add_error`.
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
        ReadAccessError(name, scenario.folder, WithOwnData(scenario.asset_folders));
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

/// Reads the banked track that the scenario's record names, and uses the track's surface as the
/// ground of the world.
std::vector<Problem> ReadRecordGround(Scenario& scenario, ReaderContext& context,
                                      const AddKeyError& add_error) {
  RecordSpec& record = *scenario.record;
  constexpr const char* kKey = "record.ground";
  if (!record.ground || !context.Read("record") || !context.Read(kKey)) {
    return {};
  }
  if (const std::string why =
          ReadAccessError(*record.ground, scenario.folder, WithOwnData(scenario.asset_folders));
      !why.empty()) {
    add_error(kKey, fmt::format("{} {}", *record.ground, why));
    return {};
  }
  if (!IsFlat(scenario.world.ground)) {
    add_error("world.ground", "must be left out, because record.ground is the ground");
    return {};
  }
  return Attempt(
      [&] {
        record.ground_data =
            std::make_shared<const BankedTrack>(ReadBankedTrack(scenario.folder / *record.ground));
        scenario.world.ground.terrain = MakeTerrain(*record.ground_data);
      },
      kKey, context, add_error);
}

/// Passes the recorded inputs to the controller if the controller replays the drive, and checks
/// that the drive contains the inputs that prediction windows need.
std::vector<Problem> TakeInputs(Scenario& scenario, ReaderContext& context,
                                const AddKeyError& add_error) {
  const RecordSpec& record = *scenario.record;
  const std::vector<std::string>& plants = scenario.drive.plants;
  ControllerOptions& steering = scenario.control.steering;
  const ControllerEntry& controller = ControllerFor(steering);
  const bool replays = controller.replays_record != nullptr && controller.replays_record(steering);
  if (!record.data || !(replays || !record.windows.empty()) ||
      std::all_of(plants.begin(), plants.end(),
                  [](const std::string& plant) { return plant == kRecordedPlant; })) {
    return {};
  }
  return Attempt(
      [&] {
        const Recording inputs = ReplayInputs(*record.data, record.steering, record.drive);
        if (replays) {
          controller.set_recording(steering, inputs);
        }
      },
      "record", context, add_error);
}

/// Reads the files that a scenario names in the section of the controller or of the planner.
class SectionReader final : public InputReader {
 public:
  /// The argument `section` is the prefix of the section's keys, such as "plan.". The argument
  /// `others` lists further folders from which files may be read.
  SectionReader(const Scenario& scenario, std::string section,
                std::vector<std::filesystem::path> others, ReaderContext& context,
                const AddKeyError& add_error)
      : scenario_(scenario),
        section_(std::move(section)),
        others_(std::move(others)),
        context_(context),
        add_error_(add_error) {}

  [[nodiscard]] bool CouldRead(const std::string& key) const override {
    return context_.Read(section_ + key);
  }

  [[nodiscard]] bool has_record() const override { return scenario_.record.has_value(); }

  void AddError(const std::string& key, std::string message) override {
    add_error_(section_ + key, std::move(message));
  }

  void ReadFile(const std::string& key, const std::string& name, const Read& read) override {
    if (const std::string why = ReadAccessError(name, scenario_.folder, others_); !why.empty()) {
      AddError(key, fmt::format("{} {}", name, why));
      return;
    }
    const std::string full_key = section_ + key;
    const std::vector<Problem> more = Attempt(
        [&] {
          try {
            read(scenario_.folder / name);
          } catch (const InputError& error) {
            throw InputError(WithFullKeys(error.problems()));
          }
        },
        full_key.c_str(), context_, add_error_);
    problems_.insert(problems_.end(), more.begin(), more.end());
  }

  /// Returns the problems that were found inside the files.
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  /// Adds the prefix of the scenario section to the keys of all problems that do not name a file.
  [[nodiscard]] std::vector<Problem> WithFullKeys(std::vector<Problem> problems) const {
    for (Problem& problem : problems) {
      if (problem.file.empty() && !problem.key.empty()) {
        problem.key.insert(0, section_);
      }
    }
    return problems;
  }

  const Scenario& scenario_;
  std::string section_;
  std::vector<std::filesystem::path> others_;
  ReaderContext& context_;
  const AddKeyError& add_error_;
  std::vector<Problem> problems_;
};

std::vector<Problem> ReadControllerFiles(Scenario& scenario, ReaderContext& context,
                                         const AddKeyError& add_error) {
  ControllerOptions& options = scenario.control.steering;
  const auto read = ControllerFor(options).read_inputs;
  SectionReader reader(scenario, "control.", scenario.asset_folders, context, add_error);
  if (read != nullptr) {
    read(options, reader);
  }
  return reader.problems();
}

std::vector<Problem> ReadPlannerFiles(Scenario& scenario, ReaderContext& context,
                                      const AddKeyError& add_error) {
  PlannerOptions& options = scenario.plan->global;
  const auto read = PlannerFor(options).read_inputs;
  SectionReader reader(scenario, PlannerSection(scenario), WithOwnData(scenario.asset_folders),
                       context, add_error);
  if (read != nullptr) {
    read(options, reader);
  }
  return reader.problems();
}

std::vector<Problem> ReadTrackInput(Scenario& scenario, ReaderContext& context,
                                    const AddKeyError& add_error) {
  TrackSpec& track = *scenario.mission.track;
  const char* key = "mission.track.file";
  if (!context.Read("mission.track") || !context.Read(key) ||
      !context.Read("mission.track.smoothing") || !context.Read("mission.track.width") ||
      track.file.empty()) {
    return {};
  }
  if (const std::string why =
          ReadAccessError(track.file, scenario.folder, WithOwnData(scenario.asset_folders));
      !why.empty()) {
    add_error(key, fmt::format("{} {}", track.file, why));
    return {};
  }
  return Attempt(
      [&] {
        TrackFile read = ReadTrackFile(scenario.folder / track.file,
                                       {.smoothing = track.smoothing, .width = track.width});
        track.data = std::make_shared<const Track>(std::move(read.track));
        track.notes = std::move(read.notes);
        if (read.chosen_smoothing) {
          track.smoothing = read.chosen_smoothing;  // smoothing wavelength of the track's copy in a
                                                    // run folder
        }
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
  if (const std::string why = ReadAccessError(map.file, scenario.folder, others); !why.empty()) {
    add_error("world.map.file", fmt::format("{} {}", map.file, why));
    return {};
  }
  const std::filesystem::path own = (scenario.folder / map.file).parent_path();
  const AccessCheck access_error = [&](const std::filesystem::path& image) {
    return ImageAccessError(image, own, others);
  };
  return Attempt(
      [&] {
        map.data =
            std::make_shared<const MapObstacles>(ReadMap(map, scenario.folder, access_error));
      },
      "world.map.file", context, add_error);
}

/// Uses the elevation of the roads on the mission's route as the ground of the world.
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
          ReadAccessError(roads.file, scenario.folder, WithOwnData(scenario.asset_folders));
      !why.empty()) {
    add_error(key, fmt::format("{} {}", roads.file, why));
    return {};
  }
  return Attempt(
      [&] {
        roads.data =
            std::make_shared<const OpenDriveFile>(ReadOpenDriveFile(scenario.folder / roads.file));
        // Use the elevation along the route as ground only if no error was found, because an error
        // may change the route.
        if (context.problems.empty()) {
          LayRouteGround(scenario, add_error);
        }
      },
      key, context, add_error);
}

}  // namespace

std::vector<std::filesystem::path> WithOwnData(std::vector<std::filesystem::path> folders) {
  try {
    folders.push_back(DataFolder());
  } catch (const InputError&) {
    // Ignore this error, because it only means that the installation has no data folder.
  }
  return folders;
}

std::string ImageAccessError(const std::filesystem::path& image,
                             const std::filesystem::path& folder,
                             const std::vector<std::filesystem::path>& others) {
  // Make both paths absolute, because lexically_relative cannot relate a relative path to an
  // absolute path.
  const std::filesystem::path from = std::filesystem::absolute(folder / ".").lexically_normal();
  const std::filesystem::path to = std::filesystem::absolute(image).lexically_normal();
  return ReadAccessError(to.lexically_relative(from).string(), folder, others);
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
    add(ReadRecordGround(scenario, context, add_error));
    add(TakeInputs(scenario, context, add_error));
  }
  if (scenario.mission.track) {
    add(ReadTrackInput(scenario, context, add_error));
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
  add(ReadControllerFiles(scenario, context, add_error));
  if (scenario.plan) {
    add(ReadPlannerFiles(scenario, context, add_error));
  }
  return problems;
}

}  // namespace trackbed
