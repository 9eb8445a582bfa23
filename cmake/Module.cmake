# trackbed_module(PATH [STATIC] [SOURCE_DIR DIR] [KIND NUMERICS|LIGHT] [FOLDERS folder...]
#                 [MODULES module...] [LIBRARIES lib...] [PRIVATE_LIBRARIES lib...])
#
# Adds one library for a module; the library is static or shared (Shared.cmake), but always static
# with the option STATIC. The code is position-independent, because the Python module links the
# static libraries. A module consists of one or more folders: the public headers of a folder are
# in include/trackbed/FOLDER, its sources are in src/FOLDER (or DIR). FOLDERS is PATH by default.
# PATH is a name such as `core`, or a path such as `planning/search` for a part of a larger module.
# The target of `planning/search` is trackbed_planning_search, exported as trackbed::planning_search.
# The modules in MODULES must be declared before this module, so that the calls are in the order of
# the modules, from the bottom up.
#
# A target sees only headers of the modules that it links: in the build tree, each module has a
# separate include directory with links to its headers.
# PrecompiledHeaders.cmake explains the argument KIND; default: NUMERICS. The target header_checks,
# which is not part of `all`, compiles each public header alone.
#
# The global property TRACKBED_MODULES lists all modules, TRACKBED_FOLDERS_<path> the folders of the
# module <path>.
set_property(GLOBAL PROPERTY TRACKBED_MODULES "")
add_custom_target(header_checks)

# Creates the symbolic link DIR/LINK to the folder SOURCE.
function(trackbed_link_folder dir link source)
  get_filename_component(parent ${dir}/${link} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${source} ${dir}/${link} SYMBOLIC)
endfunction()

# Number of sources that a unity build compiles as one. Groups of 16 sources need a fifth less processor
# time than groups of eight, and up to 1.5 GB of memory instead of 1.1 GB.
set(TRACKBED_UNITY_GROUP 16)

# Lets a unity build group the sources of a folder.
function(trackbed_group folder)
  set(count 0)
  foreach(source IN LISTS ARGN)
    math(EXPR group "${count} / ${TRACKBED_UNITY_GROUP}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${group})
    math(EXPR count "${count} + 1")
  endforeach()
endfunction()

function(trackbed_module path)
  cmake_parse_arguments(ARG "STATIC" "SOURCE_DIR;KIND" "FOLDERS;MODULES;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  if(NOT ARG_FOLDERS)
    set(ARG_FOLDERS ${path})
  endif()
  get_property(below GLOBAL PROPERTY TRACKBED_MODULES)
  foreach(module IN LISTS ARG_MODULES)
    if(NOT module IN_LIST below)
      message(FATAL_ERROR "module '${path}' may only use modules below it, and '${module}' is not")
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY TRACKBED_MODULES ${path})
  set_property(GLOBAL PROPERTY TRACKBED_FOLDERS_${path} ${ARG_FOLDERS})
  string(REPLACE "/" "_" name ${path})
  list(TRANSFORM ARG_MODULES REPLACE "/" "_")
  list(TRANSFORM ARG_MODULES PREPEND trackbed_)

  set(public ${PROJECT_BINARY_DIR}/modules/${name}/public)
  set(private ${PROJECT_BINARY_DIR}/modules/${name}/private)
  set(sources "")
  set(headers "")
  foreach(folder IN LISTS ARG_FOLDERS)
    set(source_dir src/${folder})
    if(ARG_SOURCE_DIR)
      set(source_dir ${ARG_SOURCE_DIR})
    endif()
    trackbed_link_folder(${public} trackbed/${folder} ${PROJECT_SOURCE_DIR}/include/trackbed/${folder})
    trackbed_link_folder(${private} ${source_dir} ${PROJECT_SOURCE_DIR}/${source_dir})
    file(GLOB of_folder CONFIGURE_DEPENDS ${source_dir}/*.cpp)
    trackbed_group(${folder} ${of_folder})
    list(APPEND sources ${of_folder})
    file(GLOB of_folder CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include
         ${PROJECT_SOURCE_DIR}/include/trackbed/${folder}/*.h)
    list(APPEND headers ${of_folder})
  endforeach()
  if(ARG_STATIC)
    add_library(trackbed_${name} STATIC ${sources})
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
  target_compile_options(trackbed_${name} PRIVATE ${TRACKBED_POSITION_INDEPENDENT})
  set_target_properties(trackbed_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                        UNITY_BUILD ${TRACKBED_UNITY_BUILD} UNITY_BUILD_MODE GROUP)
  target_link_libraries(
    trackbed_${name}
    PUBLIC ${ARG_MODULES} ${ARG_LIBRARIES}
    PRIVATE $<BUILD_INTERFACE:trackbed_compiler> ${ARG_PRIVATE_LIBRARIES})

  if(NOT ARG_KIND)
    set(ARG_KIND NUMERICS)
  endif()
  trackbed_precompile(trackbed_${name} ${ARG_KIND})

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
