# trackbed_room(NAME [SOURCE_DIR DIR] [KIND NUMERICS|JSON|LIGHT] [ROOMS room...] [LIBRARIES lib...]
#               [PRIVATE_LIBRARIES lib...])
#
# One static library per room: public headers in include/trackbed/NAME, sources in src/NAME (or DIR).
# ROOMS must be declared already, so the order of the calls is the order of the house.
# KIND is explained in PrecompiledHeaders.cmake; NUMERICS unless it is given.
# The target header_checks, which is no part of `all`, compiles each public header alone.
include(GNUInstallDirs)
set_property(GLOBAL PROPERTY TRACKBED_ROOMS "")
add_custom_target(header_checks)

function(trackbed_room name)
  cmake_parse_arguments(ARG "" "SOURCE_DIR;KIND" "ROOMS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  if(NOT ARG_SOURCE_DIR)
    set(ARG_SOURCE_DIR src/${name})
  endif()
  get_property(above GLOBAL PROPERTY TRACKBED_ROOMS)
  foreach(room IN LISTS ARG_ROOMS)
    if(NOT room IN_LIST above)
      message(FATAL_ERROR "room '${name}' may only use rooms above it, and '${room}' is not")
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY TRACKBED_ROOMS ${name})

  file(GLOB sources CONFIGURE_DEPENDS ${ARG_SOURCE_DIR}/*.cpp)
  add_library(trackbed_${name} STATIC ${sources})
  add_library(trackbed::${name} ALIAS trackbed_${name})
  target_include_directories(
    trackbed_${name}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_features(trackbed_${name} PUBLIC cxx_std_20)
  set_target_properties(trackbed_${name} PROPERTIES EXPORT_NAME ${name})
  list(TRANSFORM ARG_ROOMS PREPEND trackbed_)
  target_link_libraries(
    trackbed_${name}
    PUBLIC ${ARG_ROOMS} ${ARG_LIBRARIES}
    PRIVATE $<BUILD_INTERFACE:trackbed_compiler> ${ARG_PRIVATE_LIBRARIES})

  if(NOT ARG_KIND)
    set(ARG_KIND NUMERICS)
  endif()
  trackbed_precompile(trackbed_${name} ${ARG_KIND})

  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include
       ${PROJECT_SOURCE_DIR}/include/trackbed/${name}/*.h)
  set(header_checks "")
  foreach(header IN LISTS headers)
    set(file ${PROJECT_BINARY_DIR}/headers/${header}.cpp)
    file(CONFIGURE OUTPUT ${file} CONTENT "#include \"${header}\"\n")
    list(APPEND header_checks ${file})
  endforeach()
  if(header_checks)
    set(checks trackbed_${name}_header_checks)
    add_library(${checks} OBJECT EXCLUDE_FROM_ALL ${header_checks})
    target_link_libraries(${checks} PRIVATE trackbed_${name} trackbed_compiler)
    # Whether they compile is all that is asked.
    target_compile_options(${checks} PRIVATE -O0)
    add_dependencies(header_checks ${checks})
  endif()
endfunction()
