#pragma once

#include <string>
#include <vector>

#include "trackbed/options/method_rules.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/scene.h"

namespace trackbed {

/// Returns the input files of a scenario, with the names and contents that are stored in the run
/// folder. The input files are the recorded drive, track, map and road network, and the files that
/// the controller and planner read. The list of input files does not include the file of the
/// vehicle model.
std::vector<InputFile> InputFiles(const Scenario& scenario);

/// Returns all file names that InputFiles may return, for all registered controllers and planners.
std::vector<std::string> InputFileNames();

/// Whether a run folder contains the vehicle's model (kVehicleXml): true if the scenario names a
/// model file or tyre files.
bool HasOwnVehicle(const VehicleSpec& vehicle);

/// Returns the scenario's YAML like ResolvedYaml, but without start values and duration if the
/// scenario does not set them. Because unset start values stay unset, an override of a key in the
/// portable YAML has the same effect as in the scenario's own file. For example, an override of the
/// first waypoint in the portable YAML also moves the start.
std::string PortableYaml(const Scenario& scenario);

/// Returns the options with which ComposeScene makes the scenario's car. MakeSceneOptions reads the
/// tyre files of the scenario (ReadTyreFile). Errors: throws InputError if a tyre file is missing
/// or cannot be used.
SceneOptions MakeSceneOptions(const Scenario& scenario);

/// Returns the notes about how the scenario's tyre files were read; empty without tyre files.
std::vector<std::string> TyreFileNotes(const Scenario& scenario);

}  // namespace trackbed
