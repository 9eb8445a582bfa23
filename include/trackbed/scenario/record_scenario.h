#pragma once

#include <memory>
#include <string>

#include "trackbed/recording/recorded_drive.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Makes a scenario that replays a recorded drive. The only plant is kRecordedPlant; override
/// drive.plants to replay the recorded drive on other plants. The scenario has the name of the
/// recorded drive, and the gain of the speed controller is 20/s. The prediction windows are 1, 2
/// and 5 s long; windows longer than the recorded drive are omitted. The control period equals the
/// time between two recorded samples if that time is a whole number of timesteps. The argument
/// `model` is the car model, as in VehicleSpec::model.
Scenario RecordScenario(std::shared_ptr<const RecordedDrive> drive, const std::string& model);

}  // namespace trackbed
