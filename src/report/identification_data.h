#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Whether the folder contains the result of an identification.
bool IsIdentificationFolder(const std::filesystem::path& folder);

/// Returns the data of an identification for its report page. The returned JSON contains the
/// content of identify.json. For each recorded drive, the JSON also contains the curves of the
/// recording, of the model before the fit and of the model after the fit. If a file of the
/// identification is missing or invalid, throws InputError naming this file.
nlohmann::ordered_json IdentificationData(const std::filesystem::path& folder);

}  // namespace trackbed
