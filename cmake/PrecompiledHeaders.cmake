# trackbed_precompile(TARGET [TESTS])
#
# Parses once what most sources spend half their compile time on: standard containers, fmt, JSON and
# Eigen; with TESTS, GoogleTest too. One precompiled header for all targets of a kind. Public
# headers are still compiled alone, without it (trackbed_NAME_headers).
option(TRACKBED_PRECOMPILED_HEADERS "Precompile the headers that most sources include" ON)

set(common_headers <algorithm> <cmath> <filesystem> <functional> <map> <memory> <optional> <string>
                   <variant> <vector> <fmt/format.h> <nlohmann/json.hpp> <Eigen/Core>)

function(trackbed_precompiled_header target)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled/${target}.cpp CONTENT "")
  add_library(${target} OBJECT ${PROJECT_BINARY_DIR}/precompiled/${target}.cpp)
  target_link_libraries(${target} PRIVATE trackbed_compiler ${ARG_LIBRARIES})
  target_precompile_headers(${target} PRIVATE ${ARG_HEADERS})
endfunction()

if(TRACKBED_PRECOMPILED_HEADERS)
  set(libraries fmt::fmt nlohmann_json::nlohmann_json Eigen3::Eigen)
  trackbed_precompiled_header(trackbed_pch HEADERS ${common_headers} LIBRARIES ${libraries})
  if(TRACKBED_BUILD_TESTS)
    trackbed_precompiled_header(
      trackbed_tests_pch HEADERS ${common_headers} <gmock/gmock.h> <gtest/gtest.h>
      LIBRARIES ${libraries} GTest::gmock)
  endif()
endif()

function(trackbed_precompile target)
  cmake_parse_arguments(ARG "TESTS" "" "" ${ARGN})
  if(NOT TRACKBED_PRECOMPILED_HEADERS)
    return()
  endif()
  if(ARG_TESTS)
    target_precompile_headers(${target} REUSE_FROM trackbed_tests_pch)
  else()
    target_precompile_headers(${target} REUSE_FROM trackbed_pch)
  endif()
endfunction()
