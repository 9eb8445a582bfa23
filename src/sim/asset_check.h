#pragma once

#include <tinyxml2.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

/// What a model from elsewhere may contain, looked at before MuJoCo reads it.
namespace trackbed {

/// Of one file.
inline constexpr std::size_t kMostAssetBytes = std::size_t{64} << 20;
/// Files, fewer than the 2000 of the virtual file system of MuJoCo 2.2.2.
inline constexpr std::size_t kMostAssets = 1900;
/// Of all files together.
inline constexpr std::size_t kMostAssetBytesInAll = std::size_t{512} << 20;

/// What is wrong with the content of a file that an asset of this kind ("mesh", "texture", …)
/// refers to, as the end of a sentence: "is no PNG picture". Empty when nothing is.
std::string WhyNoAsset(std::string_view kind, const std::filesystem::path& file,
                       std::string_view content);

/// What is wrong with an element of the composed model, as a sentence. Empty when nothing is.
std::string WhyNoElement(const tinyxml2::XMLElement& element);

}  // namespace trackbed
