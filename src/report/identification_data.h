#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Whether it is the folder of an identification.
bool IsIdentificationFolder(const std::filesystem::path& folder);

/// What the page shows of an identification: identify.json, and over time what each record and the
/// model before and after the fit do. InputError naming what is missing or broken.
nlohmann::ordered_json IdentificationData(const std::filesystem::path& folder);

}  // namespace trackbed
