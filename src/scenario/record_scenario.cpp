#include "trackbed/scenario/record_scenario.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/scenario/local_origin.h"
#include "trackbed/control/playback.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file_name.h"
#include "trackbed/recording/record_csv.h"
#include "trackbed/recording/windows.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

Scenario RecordScenario(std::shared_ptr<const RecordedDrive> drive, const std::string& model) {
  Scenario scenario;
  scenario.name = FileNameOf(drive->name);
  scenario.vehicle.model = model;
  scenario.record = RecordSpec{.file = kRecordCsv, .map = {}};
  RecordSpec& record = *scenario.record;
  for (const double window : {1.0, 2.0, 5.0}) {
    if (window <= drive->duration()) {
      record.windows.push_back(window);
    }
  }
  if (!drive->has_steering_command && drive->has_steering) {
    record.steering = ReplaySteering::kMeasured;
  }
  PlaybackOptions playback;
  try {
    playback.recording = ReplayInputs(*drive, record.steering, record.drive);
  } catch (const InputError&) {
    // A recorded drive without a steering signal or with driving in reverse can be viewed and
    // compared, but not replayed.
    record.windows.clear();
    playback.recording.steering = {{{0.0, 0.0}}};
  }
  scenario.control.steering = std::move(playback);
  scenario.control.speed.gain = ReplayOptions{}.speed_gain;
  scenario.drive.plants = {kRecordedPlant};
  scenario.drive.time_limit = std::max(scenario.drive.time_limit, drive->duration() + 1.0);
  const double steps = drive->period / scenario.drive.timestep;
  if (std::round(steps) >= 1.0 && std::abs(steps - std::round(steps)) < 1e-6) {
    scenario.drive.control_period = std::round(steps) * scenario.drive.timestep;
  }
  record.data = std::move(drive);
  const auto problem = MoveToLocalOrigin(scenario);
  TRACKBED_CHECK(!problem, "the record contradicts itself: {}", problem->second);
  return scenario;
}

}  // namespace trackbed
