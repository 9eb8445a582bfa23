#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Whether the folder contains the result of an identification.
bool IsIdentificationFolder(const std::filesystem::path& folder);

/// Returns the data of an identification for its report page. The data are the content of
/// identify.json, and the curves of each record, of the model before the fit and of the model after
/// the fit. Throws InputError naming a missing or invalid file.
nlohmann::ordered_json IdentificationData(const std::filesystem::path& folder);

}  // namespace trackbed
