# `cmake --install` installs the program, the package `trackbed` for CMake and pkg-config, the
# models and scenarios, and the documentation. All installed paths are relative to the CMake package
# or to the program, so the installation can be moved. The installed targets are:
#
#   trackbed::trackbed   the library: all modules but testing
#   trackbed::MODULE     one module, such as trackbed::drive or trackbed::planning_search
#   trackbed::testing    matchers for tests, with find_package(trackbed COMPONENTS testing): only
#                        this component needs GoogleTest
#   trackbed::cli        the program; its module is trackbed::cli_library
#
# docs/how-to/embed.md lists the libraries that each module links.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/trackbed)
set(data_folder ${CMAKE_INSTALL_DATADIR}/trackbed)

# Defines the target trackbed::trackbed and the header trackbed/trackbed.h, each of which covers all
# modules.
add_library(trackbed_library INTERFACE)
trackbed_link_folder(${PROJECT_BINARY_DIR}/modules/library trackbed/trackbed.h
                     ${PROJECT_SOURCE_DIR}/include/trackbed/trackbed.h)
target_include_directories(
  trackbed_library INTERFACE $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/modules/library>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

set(installed trackbed_version trackbed_library)
get_property(modules GLOBAL PROPERTY TRACKBED_MODULES)
foreach(module IN LISTS modules)
  string(REPLACE "/" "_" name ${module})
  if(module STREQUAL "testing")
    install(TARGETS trackbed_testing EXPORT trackbedTestingTargets)
    install(EXPORT trackbedTestingTargets NAMESPACE trackbed:: DESTINATION ${package_folder})
  else()
    list(APPEND installed trackbed_${name})
    target_link_libraries(trackbed_library INTERFACE trackbed_${name})
  endif()
endforeach()

# Headers that programs may include (docs/how-to/embed.md). The public headers and all headers that
# they include are installed. Headers that are not installed are internal.
set(public_headers
    trackbed.h
    analysis/compare_runs.h
    analysis/margins.h
    analysis/metric_registry.h
    analysis/path_properties.h
    analysis/run_folder.h
    analysis/statistics.h
    analysis/suite.h
    core/angle.h
    core/version.h
    falsify/falsify.h
    falsify/verify.h
    fmu/export.h
    identify/identify.h
    identify/identify_files.h
    path_files/path_file.h
    recording/import_log.h
    render/film.h
    report/report.h
    requirement/robustness.h
    road_network/lane_route.h
    road_network/open_drive.h
    track/track_file.h
    planning/common/course_schedule.h
    planning/common/curvature_steps.h
    planning/curves/dubins.h
    planning/curves/reeds_shepp.h
    planning/grid/astar.h
    planning/grid/map_grid.h
    planning/path_file/path_check.h
    sim/mujoco_error.h
    testing/falsify_testing.h
    testing/scenario_testing.h
    watch/watch.h)
if(NOT TARGET trackbed_testing)
  list(FILTER public_headers EXCLUDE REGEX "^testing/")
endif()
# The installation follows the `#include` lines of the public headers anew, because these may have
# changed since the configuration.
install(
  CODE "set(include_folder \"${PROJECT_SOURCE_DIR}/include\")
set(destination \"${CMAKE_INSTALL_INCLUDEDIR}\")
set(public_headers \"${public_headers}\")")
install(SCRIPT cmake/InstallHeaders.cmake)
set_target_properties(trackbed_version PROPERTIES EXPORT_NAME version)
set_target_properties(trackbed_library PROPERTIES EXPORT_NAME trackbed)
set_target_properties(trackbed_cli PROPERTIES EXPORT_NAME cli_library)
set_target_properties(trackbed PROPERTIES EXPORT_NAME cli)
# Installs MuJoCo from the wheel or the archive into a private folder with the layout of an archive.
# Projects that link Trackbed compile against MuJoCo's headers in this private folder.
set(mujoco_folder ${CMAKE_INSTALL_LIBDIR}/trackbed/mujoco)
if(TRACKBED_MUJOCO_FOLDER)
  install(DIRECTORY ${TRACKBED_MUJOCO_FOLDER}/include/mujoco DESTINATION ${mujoco_folder}/include)
  install(DIRECTORY ${TRACKBED_MUJOCO_FOLDER}/lib/ DESTINATION ${mujoco_folder}/lib
          FILES_MATCHING PATTERN libmujoco.so* PATTERN cmake EXCLUDE)
  # A wheel of MuJoCo contains the license files in licenses/; an archive contains the license files
  # beside the folders include/ and lib/.
  file(GLOB licenses ${TRACKBED_MUJOCO_FOLDER}/licenses/* ${TRACKBED_MUJOCO_FOLDER}/LICENSE*
       ${TRACKBED_MUJOCO_FOLDER}/THIRD_PARTY_NOTICES*)
  install(FILES ${licenses} DESTINATION ${CMAKE_INSTALL_DOCDIR}/mujoco)
endif()
set_target_properties(trackbed PROPERTIES INSTALL_RPATH "${TRACKBED_PROGRAM_RPATH}")
if(NOT BUILD_SHARED_LIBS)
  install(TARGETS trackbed_default_place)
  add_dependencies(trackbed trackbed_default_place)
endif()
install(TARGETS ${installed} trackbed EXPORT trackbedTargets)
install(EXPORT trackbedTargets NAMESPACE trackbed:: DESTINATION ${package_folder})
# Does not install scenarios/validation, because these scenarios replay recordings in tests/, which
# is not installed.
install(DIRECTORY models scenarios DESTINATION ${data_folder} PATTERN validation EXCLUDE)

set(mujoco_of_package debian)
if(TRACKBED_MUJOCO_FOLDER)
  set(mujoco_of_package carried)
endif()
configure_package_config_file(cmake/trackbedConfig.cmake.in package/trackbedConfig.cmake
                              INSTALL_DESTINATION ${package_folder} PATH_VARS data_folder mujoco_folder)
write_basic_package_version_file(package/trackbedConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(
  FILES ${PROJECT_BINARY_DIR}/package/trackbedConfig.cmake
        ${PROJECT_BINARY_DIR}/package/trackbedConfigVersion.cmake cmake/LibraryDependencies.cmake
        cmake/Mujoco.cmake cmake/Place.cmake
  DESTINATION ${package_folder})
include(PkgConfig)
include(Documentation)
