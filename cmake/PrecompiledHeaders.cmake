# trackbed_precompile(TARGET KIND)
#
# Parses once what most sources spend half their compile time on: standard containers, fmt and Eigen.
# KIND also says what the target is compiled for:
#   NUMERICS  standard containers, fmt, Eigen
#   LIGHT     JSON as well, at -O1: targets that read, write and judge, where a third of the compile time
#             went into optimizing code that takes no time
#   TESTS     as LIGHT, with GoogleTest
# One precompiled header for all targets of a kind; GCC takes the optimization level from it. Public
# headers are still compiled alone, without it (header_checks).
option(TRACKBED_PRECOMPILED_HEADERS "Precompile the headers that most sources include" ON)

set(light $<$<CONFIG:Release>:-O1>)

function(trackbed_precompiled_header kind)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES;OPTIONS" ${ARGN})
  string(TOLOWER trackbed_${kind}_pch target)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled/${target}.cpp CONTENT "")
  add_library(${target} OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled/${target}.cpp)
  target_link_libraries(${target} PRIVATE trackbed_compiler fmt::fmt Eigen3::Eigen ${ARG_LIBRARIES})
  target_compile_options(${target} PRIVATE ${ARG_OPTIONS})
  # GCC uses a precompiled header only with the flags it was compiled with.
  if(BUILD_SHARED_LIBS AND NOT kind STREQUAL TESTS)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_precompile_headers(
    ${target} PRIVATE <algorithm> <cmath> <filesystem> <functional> <map> <memory> <optional>
    <string> <variant> <vector> <fmt/format.h> <Eigen/Core> ${ARG_HEADERS})
endfunction()

if(TRACKBED_PRECOMPILED_HEADERS)
  set(json HEADERS <nlohmann/json.hpp> LIBRARIES nlohmann_json::nlohmann_json)
  trackbed_precompiled_header(NUMERICS)
  trackbed_precompiled_header(LIGHT ${json} OPTIONS ${light})
  if(TRACKBED_BUILD_TESTS)
    trackbed_precompiled_header(
      TESTS HEADERS <nlohmann/json.hpp> <gmock/gmock.h> <gtest/gtest.h>
      LIBRARIES nlohmann_json::nlohmann_json GTest::gmock OPTIONS ${light})
  endif()
endif()

function(trackbed_precompile target kind)
  if(kind MATCHES "LIGHT|TESTS")
    target_compile_options(${target} PRIVATE ${light})
  endif()
  if(TRACKBED_PRECOMPILED_HEADERS)
    string(TOLOWER trackbed_${kind}_pch header)
    target_precompile_headers(${target} REUSE_FROM ${header})
  endif()
endfunction()
