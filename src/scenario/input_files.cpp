#include "trackbed/scenario/input_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/scenario/input_files.h"
#include "src/scenario/local_origin.h"
#include "src/scenario/scenario_yaml.h"
#include "trackbed/control/controllers.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/recording/banked_track.h"
#include "trackbed/recording/record_csv.h"
#include "trackbed/road_network/open_drive.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/sim/scene.h"
#include "trackbed/track/track_file.h"
#include "trackbed/vehicle/tyre_file.h"

// Defines the input files in a run folder: their names, their contents, and the keys of the
// resolved scenario that refer to them. The registry entry of a controller or planner defines its
// input files.
namespace trackbed {
namespace {

void Append(std::vector<InputFile> more, std::vector<InputFile>& files) {
  files.insert(files.end(), more.begin(), more.end());
}

/// Returns whether the controller replays the scenario's recorded drive instead of a separate
/// recording file.
bool ReplaysRecord(const Scenario& scenario) {
  const ControllerEntry& controller = ControllerFor(scenario.control.steering);
  return scenario.record && controller.replays_record != nullptr &&
         controller.replays_record(scenario.control.steering);
}

}  // namespace

std::vector<InputFile> InputFiles(const Scenario& from_origin) {
  const Scenario scenario = InFileCoordinates(from_origin, /*with_files=*/true);
  std::vector<InputFile> files;
  if (const auto& record = scenario.record) {
    files.push_back({kRecordCsv, RecordCsv(*record->data), "record " + record->file});
    if (record->ground_data) {
      files.push_back(
          {kBankCsv, BankedTrackCsv(*record->ground_data), "ground " + *record->ground});
    }
  }
  if (const auto& track = scenario.mission.track) {
    files.push_back({kTrackCsv, TrackCsv(track->data->points()), "track " + track->file});
  }
  if (const auto& map = scenario.world.map) {
    files.push_back({kMapYaml, MapYaml(map->data->map()), "map " + map->file});
    files.push_back({kMapPgm, MapPgm(map->data->map()), "map " + map->file});
  }
  if (const auto& roads = scenario.world.road_network) {
    files.push_back({kRoadNetworkXodr, roads->data->text, "road network " + roads->file});
  }
  const ControllerOptions& steering = scenario.control.steering;
  const ControllerEntry& controller = ControllerFor(steering);
  if (controller.input_files != nullptr && !ReplaysRecord(scenario)) {
    Append(controller.input_files(steering), files);
  }
  if (const auto& plan = scenario.plan) {
    const PlannerEntry& planner = PlannerFor(plan->global);
    if (planner.input_files != nullptr) {
      Append(planner.input_files(plan->global), files);
    }
  }
  return files;
}

std::vector<std::string> InputFileNames() {
  std::vector<std::string> names{kRoadNetworkXodr};
  for (const ControllerEntry& controller : Controllers()) {
    names.insert(names.end(), controller.input_names.begin(), controller.input_names.end());
  }
  for (const PlannerEntry& planner : Planners()) {
    names.insert(names.end(), planner.input_names.begin(), planner.input_names.end());
  }
  names.insert(names.end(), {kRecordCsv, kBankCsv, kTrackCsv, kMapYaml, kMapPgm});
  return names;
}

namespace {

/// The tyre property files of the front and rear axle that a scenario names.
struct AxleTyres {
  TyreFile front;
  TyreFile rear;
};

TyreFile ReadTyre(const Scenario& scenario, const std::string& file, const char* key) {
  try {
    return ReadTyreFile(scenario.folder / file);
  } catch (const RunError& error) {
    throw InputError(Problem{.key = key, .message = error.what()});
  }
}

std::optional<AxleTyres> ReadTyres(const Scenario& scenario) {
  const VehicleSpec& vehicle = scenario.vehicle;
  if (!vehicle.tyre_file) {
    return std::nullopt;
  }
  AxleTyres tyres;
  tyres.front = ReadTyre(scenario, *vehicle.tyre_file, "vehicle.tyre_file");
  tyres.rear = vehicle.tyre_file_rear
                   ? ReadTyre(scenario, *vehicle.tyre_file_rear, "vehicle.tyre_file_rear")
                   : tyres.front;
  return tyres;
}

}  // namespace

Scenario WithResolvedFiles(const Scenario& scenario) {
  Scenario resolved = scenario;
  if (auto& record = resolved.record) {
    record->file = kRecordCsv;
    record->map.reset();
    if (record->ground) {
      record->ground = kBankCsv;
    }
    record->from.reset();
    record->to.reset();
    if (record->data) {
      record->notes = fmt::format("{}", fmt::join(record->data->notes, "\n"));
    }
  }
  if (auto& track = resolved.mission.track) {
    track->file = kTrackCsv;
    track->width.reset();  // the file written by TrackCsv contains the widths
  }
  if (HasOwnVehicle(scenario.vehicle)) {
    resolved.vehicle.model = kVehicleXml;
    resolved.vehicle.tyre_file.reset();
    resolved.vehicle.tyre_file_rear.reset();
  }
  if (auto& map = resolved.world.map) {
    *map = {.file = kMapYaml, .unknown = map->unknown, .height = map->height};
  }
  if (resolved.world.road_network) {
    resolved.world.road_network->file = kRoadNetworkXodr;
  }
  const ControllerEntry& controller = ControllerFor(resolved.control.steering);
  if (controller.resolve != nullptr) {
    controller.resolve(resolved.control.steering, ReplaysRecord(scenario));
  }
  if (auto& plan = resolved.plan) {
    const PlannerEntry& planner = PlannerFor(plan->global);
    if (planner.resolve != nullptr) {
      planner.resolve(plan->global);
    }
  }
  return resolved;
}

bool HasOwnVehicle(const VehicleSpec& vehicle) {
  return IsModelPath(vehicle.model) || vehicle.tyre_file;
}

SceneOptions MakeSceneOptions(const Scenario& scenario) {
  SceneOptions options{.timestep = scenario.drive.timestep,
                       .steering_rate = scenario.vehicle.steering_rate,
                       .asset_folders = scenario.asset_folders};
  if (const std::optional<AxleTyres> tyres = ReadTyres(scenario)) {
    options.tyre_numbers = TyreNumbers(tyres->front, tyres->rear);
  }
  return options;
}

std::vector<std::string> TyreFileNotes(const Scenario& scenario) {
  std::vector<std::string> notes;
  if (const std::optional<AxleTyres> tyres = ReadTyres(scenario)) {
    for (const std::string& note : tyres->front.notes) {
      notes.push_back("vehicle.tyre_file: " + note);
    }
    if (scenario.vehicle.tyre_file_rear) {
      for (const std::string& note : tyres->rear.notes) {
        notes.push_back("vehicle.tyre_file_rear: " + note);
      }
    }
  }
  return notes;
}

std::string PortableYaml(const Scenario& scenario) {
  return YamlOf(WithResolvedFiles(scenario));
}

}  // namespace trackbed
