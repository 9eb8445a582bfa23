# trackbed_module(PATH [STATIC] [SOURCE_DIR DIR] [KIND NUMERICS|LIGHT] [MODULES module...]
#                 [LIBRARIES lib...] [PRIVATE_LIBRARIES lib...])
#
# Adds one library for a module; the library is static or shared (Shared.cmake), but always static
# with the option STATIC. Public headers are in include/trackbed/PATH, sources are in src/PATH (or
# DIR). PATH is a name such as `core`, or a path such as `planning/fillet` for a part of a larger
# module. The target of `planning/fillet` is trackbed_planning_fillet, exported as
# trackbed::planning_fillet. The modules in MODULES must be declared before this module, so that the
# calls are in the order of the modules, from the bottom up.
#
# A target sees only headers of the modules that it links: in the build tree, each module has a
# separate include directory with a link to its headers.
# PrecompiledHeaders.cmake explains the argument KIND; default: NUMERICS. The target header_checks,
# which is not part of `all`, compiles each public header alone.
set_property(GLOBAL PROPERTY TRACKBED_MODULES "")
add_custom_target(header_checks)

# Creates the symbolic link DIR/LINK to the folder SOURCE.
function(trackbed_link_folder dir link source)
  get_filename_component(parent ${dir}/${link} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${source} ${dir}/${link} SYMBOLIC)
endfunction()

function(trackbed_module path)
  cmake_parse_arguments(ARG "STATIC" "SOURCE_DIR;KIND" "MODULES;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  if(NOT ARG_SOURCE_DIR)
    set(ARG_SOURCE_DIR src/${path})
  endif()
  get_property(below GLOBAL PROPERTY TRACKBED_MODULES)
  foreach(module IN LISTS ARG_MODULES)
    if(NOT module IN_LIST below)
      message(FATAL_ERROR "module '${path}' may only use modules below it, and '${module}' is not")
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY TRACKBED_MODULES ${path})
  string(REPLACE "/" "_" name ${path})
  list(TRANSFORM ARG_MODULES REPLACE "/" "_")
  list(TRANSFORM ARG_MODULES PREPEND trackbed_)

  set(public ${PROJECT_BINARY_DIR}/modules/${name}/public)
  set(private ${PROJECT_BINARY_DIR}/modules/${name}/private)
  trackbed_link_folder(${public} trackbed/${path} ${PROJECT_SOURCE_DIR}/include/trackbed/${path})
  trackbed_link_folder(${private} ${ARG_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/${ARG_SOURCE_DIR})

  file(GLOB sources CONFIGURE_DEPENDS ${ARG_SOURCE_DIR}/*.cpp)
  if(ARG_STATIC)
    add_library(trackbed_${name} STATIC ${sources})
    if(BUILD_SHARED_LIBS) # as for the precompiled headers that the target shares
      set_target_properties(trackbed_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
  else()
    add_library(trackbed_${name} ${sources})
    trackbed_shared_properties(trackbed_${name})
  endif()
  add_library(trackbed::${name} ALIAS trackbed_${name})
  target_include_directories(
    trackbed_${name}
    PUBLIC $<BUILD_INTERFACE:${public}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${private})
  target_compile_features(trackbed_${name} PUBLIC cxx_std_20)
  set_target_properties(trackbed_${name} PROPERTIES EXPORT_NAME ${name}
                        UNITY_BUILD ${TRACKBED_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 8)
  target_link_libraries(
    trackbed_${name}
    PUBLIC ${ARG_MODULES} ${ARG_LIBRARIES}
    PRIVATE $<BUILD_INTERFACE:trackbed_compiler> ${ARG_PRIVATE_LIBRARIES})

  if(NOT ARG_KIND)
    set(ARG_KIND NUMERICS)
  endif()
  trackbed_precompile(trackbed_${name} ${ARG_KIND})

  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include
       ${PROJECT_SOURCE_DIR}/include/trackbed/${path}/*.h)
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
    # Compile the header checks without optimization, because the compiled code is never run.
    target_compile_options(${checks} PRIVATE -O0)
    add_dependencies(header_checks ${checks})
  endif()
endfunction()
