# trackbed_precompile(TARGET KIND)
#
# Lets TARGET use a precompiled header with the headers that take half of the compile time of most
# sources. KIND selects the headers and the optimization:
#   NUMERICS  standard containers, fmt and Eigen, with the optimization of the preset.
#   LIGHT     also JSON, with -O1, for targets that read, write and evaluate results. Full
#             optimization of the targets of kind LIGHT took a third of the compile time without
#             benefit.
#   TESTS     also GoogleTest, with -Og. With -O1 the tests took a quarter more compile time.
#
# All targets of a kind share one precompiled header, because GCC takes the optimization level from
# the precompiled header. The compiler rejects a precompiled header if the header reads a macro that
# has another value in the target. Some libraries define macros that system headers read: for
# example, tinyxml2 in Debian 13 defines _FILE_OFFSET_BITS. Targets whose libraries define such
# macros therefore share a second precompiled header, compiled with these macros. If a macro does
# not match TRACKBED_MACROS_OF_PRECOMPILED, GCC warns and parses the headers as text. The target
# header_checks still compiles each public header alone, without a precompiled header.
option(TRACKBED_PRECOMPILED_HEADERS "Precompile the headers that most sources include" ON)

# Optimization of the kinds that differ from the preset.
set(trackbed_optimization_LIGHT $<$<CONFIG:Release>:-O1>)
set(trackbed_optimization_TESTS $<$<CONFIG:Release>:-Og>)
# Regular expression for the names of macros that the precompiled headers may read: reserved names,
# which system headers read, and macros of the libraries.
set(TRACKBED_MACROS_OF_PRECOMPILED "^(_|NDEBUG|EIGEN_|FMT_|JSON_|NLOHMANN_|GTEST_|GMOCK_)")

# Sets OUT to the macros that libraries define for TARGET and that the precompiled headers may read.
function(trackbed_library_macros target out)
  set(macros "")
  set(seen "")
  get_target_property(libraries ${target} LINK_LIBRARIES)
  while(libraries)
    list(POP_FRONT libraries library)
    string(REGEX REPLACE "^\\$<BUILD_INTERFACE:(.*)>$" "\\1" library "${library}")
    if(NOT TARGET "${library}" OR library IN_LIST seen)
      continue()
    endif()
    list(APPEND seen ${library})
    get_target_property(definitions ${library} INTERFACE_COMPILE_DEFINITIONS)
    if(definitions)
      list(APPEND macros ${definitions})
    endif()
    get_target_property(below ${library} INTERFACE_LINK_LIBRARIES)
    if(below)
      list(APPEND libraries ${below})
    endif()
  endwhile()
  list(FILTER macros INCLUDE REGEX "${TRACKBED_MACROS_OF_PRECOMPILED}")
  list(REMOVE_DUPLICATES macros)
  list(SORT macros)
  set(${out} "${macros}" PARENT_SCOPE)
endfunction()

# Sets OUT to the target with the precompiled header of KIND, compiled with the macros in the
# remaining arguments.
function(trackbed_precompiled_header kind out)
  string(TOLOWER trackbed_${kind}_pch target)
  set(headers "")
  set(libraries fmt::fmt Eigen3::Eigen)
  if(kind MATCHES "LIGHT|TESTS")
    list(APPEND headers <nlohmann/json.hpp>)
    list(APPEND libraries nlohmann_json::nlohmann_json)
  endif()
  if(kind STREQUAL "TESTS")
    list(APPEND headers <gmock/gmock.h> <gtest/gtest.h>)
    list(APPEND libraries GTest::gmock)
  endif()
  # Ignore the macros of fmt: every target links fmt through the module core, so these macros need
  # no second precompiled header.
  set(macros ${ARGN})
  get_target_property(common fmt::fmt INTERFACE_COMPILE_DEFINITIONS)
  list(REMOVE_ITEM macros ${common})
  if(macros)
    string(SHA256 hash "${macros}")
    string(SUBSTRING ${hash} 0 8 hash)
    string(APPEND target _${hash})
  endif()
  set(${out} ${target} PARENT_SCOPE)
  if(TARGET ${target})
    return()
  endif()
  set(source ${PROJECT_BINARY_DIR}/precompiled/${target}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(${target} OBJECT EXCLUDE_FROM_ALL ${source})
  target_link_libraries(${target} PRIVATE trackbed_compiler ${libraries})
  target_compile_definitions(${target} PRIVATE ${macros})
  target_compile_options(${target} PRIVATE ${trackbed_optimization_${kind}})
  # GCC uses a precompiled header only if the target has the same compiler flags as the header, such
  # as position-independent code.
  if(NOT kind STREQUAL "TESTS")
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_options(${target} PRIVATE ${TRACKBED_POSITION_INDEPENDENT})
  endif()
  target_precompile_headers(
    ${target} PRIVATE <algorithm> <cmath> <filesystem> <functional> <map> <memory> <optional>
    <string> <variant> <vector> <fmt/format.h> <Eigen/Core> ${headers})
endfunction()

if(TRACKBED_PRECOMPILED_HEADERS)
  trackbed_precompiled_header(NUMERICS header)
  trackbed_precompiled_header(LIGHT header)
  if(TRACKBED_BUILD_TESTS)
    trackbed_precompiled_header(TESTS header)
  endif()
endif()

# Sets the precompiled header of a target. CMake calls trackbed_use_precompiled_header at the end of
# the folder, when the target already links all its libraries.
function(trackbed_use_precompiled_header target kind)
  trackbed_library_macros(${target} macros)
  trackbed_precompiled_header(${kind} header ${macros})
  target_precompile_headers(${target} REUSE_FROM ${header})
endfunction()

function(trackbed_precompile target kind)
  target_compile_options(${target} PRIVATE ${trackbed_optimization_${kind}})
  if(TRACKBED_PRECOMPILED_HEADERS)
    cmake_language(EVAL CODE "cmake_language(DEFER CALL trackbed_use_precompiled_header ${target} ${kind})")
  endif()
endfunction()
