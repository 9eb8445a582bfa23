# Adds trackbed_version, a library that returns the version determined by git; each build updates
# the version.
find_package(Git QUIET)
set(TRACKBED_VERSION_FILE ${PROJECT_BINARY_DIR}/version/version.cpp)
add_custom_target(
  trackbed_describe
  BYPRODUCTS ${TRACKBED_VERSION_FILE}
  COMMAND ${CMAKE_COMMAND} -DGIT=${GIT_EXECUTABLE} -DSOURCE_DIR=${PROJECT_SOURCE_DIR}
          -DVERSION=${PROJECT_VERSION} -DOUTPUT=${TRACKBED_VERSION_FILE} -P
          ${PROJECT_SOURCE_DIR}/cmake/describe.cmake
  COMMENT "")
add_library(trackbed_version ${TRACKBED_VERSION_FILE})
set_target_properties(trackbed_version PROPERTIES POSITION_INDEPENDENT_CODE ON)
trackbed_shared_properties(trackbed_version)
add_dependencies(trackbed_version trackbed_describe)
target_link_libraries(trackbed_version PRIVATE $<BUILD_INTERFACE:trackbed_compiler>)
target_include_directories(trackbed_version PRIVATE ${PROJECT_SOURCE_DIR}/include)
