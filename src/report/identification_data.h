#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Whether the folder contains an identification.
bool IsIdentificationFolder(const std::filesystem::path& folder);

/// Data of an identification for the page: identify.json, and over time each record with the model
/// before and after the fit. Throws InputError naming a missing or invalid file.
nlohmann::ordered_json IdentificationData(const std::filesystem::path& folder);

}  // namespace trackbed
