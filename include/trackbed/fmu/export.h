#pragma once

#include <filesystem>
#include <string>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Version of the Functional Mock-up Interface.
enum class FmiVersion { k2 = 2, k3 = 3 };

/// Comment at the end of the ZIP files that ExportFmu writes.
inline constexpr const char* kFmuMark = "FMU by Trackbed";

/// Exports the car of a scenario as a co-simulation FMU (fmi-standard.org): a ZIP file with the
/// description of its variables, a shared library with the libraries that it needs, the scenario,
/// and all files that the scenario names. docs/how-to/fmu.md describes the variables and the
/// behavior of the FMU.
///
/// `plant` is the plant that the FMU simulates; the plants in `scenario` are ignored. The export
/// omits the scenario's expectations and video settings. ExportFmu replaces an existing file.
///
/// Guarantees: outside of its shared library, the FMU contains no file path of this machine. Two
/// exports of the same scenario are identical files. Before the file is written, the FMU is
/// instantiated and initialized once, so that an FMU without a plan is not written.
///
/// Cost: about two seconds, mostly to compress the libraries (about 30 MB).
///
/// Errors: throws InputError if the plant cannot be stepped, or if FMI 2 does not know the
/// machine's architecture. Also throws InputError if the FMU does not start. An FMU does not start,
/// for example, without a plan, or with a planner or controller that the calling program
/// registered. Throws RunError if the shared library of FMUs (trackbed_fmu.so) is missing or the
/// file cannot be written.
void ExportFmu(const Scenario& scenario, const std::string& plant,
               const std::filesystem::path& file, FmiVersion version = FmiVersion::k3);

}  // namespace trackbed
