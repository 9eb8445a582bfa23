# `cmake --install` puts in place: the program; the package `trackbed` (every module as
# trackbed::NAME; `testing` where there is GoogleTest); and the models and scenarios. Everything is
# found from where the package or the program lies, so that all of it can be moved together.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/trackbed)
set(data_folder ${CMAKE_INSTALL_DATADIR}/trackbed)

set(installed trackbed_version)
get_property(modules GLOBAL PROPERTY TRACKBED_MODULES)
foreach(module IN LISTS modules)
  string(REPLACE "/" "_" name ${module})
  list(APPEND installed trackbed_${name})
  get_filename_component(folder trackbed/${module} DIRECTORY)
  install(DIRECTORY include/trackbed/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
endforeach()
set_target_properties(trackbed_version PROPERTIES EXPORT_NAME version)
install(TARGETS ${installed} trackbed EXPORT trackbedTargets)
install(EXPORT trackbedTargets NAMESPACE trackbed:: DESTINATION ${package_folder})
# Without scenarios/validation, which replays the tests' recordings.
install(DIRECTORY models scenarios DESTINATION ${data_folder} PATTERN validation EXCLUDE)

configure_package_config_file(cmake/trackbedConfig.cmake.in package/trackbedConfig.cmake
                              INSTALL_DESTINATION ${package_folder} PATH_VARS data_folder)
write_basic_package_version_file(package/trackbedConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(
  FILES ${PROJECT_BINARY_DIR}/package/trackbedConfig.cmake
        ${PROJECT_BINARY_DIR}/package/trackbedConfigVersion.cmake cmake/LibraryDependencies.cmake
        cmake/Place.cmake
  DESTINATION ${package_folder})
