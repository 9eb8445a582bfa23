# Generates a C++ file with the SHA-256 hash of every file in models/. A model in any folder counts
# as shipped with Trackbed if the hashes of all its files are in the generated list.
file(GLOB_RECURSE model_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/models/*)
set(shipped_hashes "")
foreach(file IN LISTS model_files)
  file(SHA256 ${file} hash)
  string(APPEND shipped_hashes "    \"${hash}\",\n")
endforeach()
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${model_files})
list(LENGTH model_files shipped_count)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/shipped_models/shipped_models.h
     CONTENT "#pragma once

#include <array>
#include <string_view>

namespace trackbed {

inline constexpr std::array<std::string_view, @shipped_count@> kShippedHashes{
@shipped_hashes@};

}  // namespace trackbed
" @ONLY)
target_include_directories(trackbed_sim PRIVATE ${PROJECT_BINARY_DIR}/shipped_models)
