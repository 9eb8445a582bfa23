#pragma once

#include <tinyxml2.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

/// Checks of untrusted model files before MuJoCo reads them.
namespace trackbed {

/// Largest size of one asset file.
inline constexpr std::size_t kMaxAssetBytes = std::size_t{64} << 20;
/// Largest number of asset files. The limit is below the 2000 files of the virtual file system of
/// MuJoCo 2.2.2.
inline constexpr std::size_t kMaxAssets = 1900;
/// Largest size of all asset files together.
inline constexpr std::size_t kMaxTotalAssetBytes = std::size_t{512} << 20;

/// Error in the content of an asset file of this kind ("mesh", "texture", …). The error text is the
/// end of a sentence, such as "is no PNG picture". AssetError returns an empty text if the content
/// is valid.
std::string AssetError(std::string_view kind, const std::filesystem::path& file,
                       std::string_view content);

/// Error in an element of the composed model, as a sentence. ElementError returns an empty text if
/// the element is valid.
std::string ElementError(const tinyxml2::XMLElement& element);

}  // namespace trackbed
