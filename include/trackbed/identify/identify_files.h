#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "trackbed/analysis/output_folder.h"
#include "trackbed/identify/identify.h"

/// Writes the results of an identification.
namespace trackbed {

/// Returns the result of an identification in the format of identify.json.
nlohmann::ordered_json ToJson(const IdentificationResult& result);

/// Returns the names of the files that WriteIdentification writes to its folder. The file names
/// depend only on the study, not on the result.
std::vector<std::string> IdentificationFiles(const Identification& study);

/// Returns the run folder of an identification's record in the output folder. Throws RunError in
/// the same cases as FolderBelow.
std::filesystem::path RecordFolder(const std::filesystem::path& folder, const std::string& record);

/// Writes identify.json, the fitted model `<vehicle>.xml` with its assets, and timing.json. For
/// each record, also writes the residuals to `<record>.residuals.csv`, and a run folder with the
/// fitted model to `records/<record>`.
void WriteIdentification(const IdentificationResult& result, const OutputFolder& folder);

}  // namespace trackbed
