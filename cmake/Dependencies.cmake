# Finds all libraries among the installed Debian packages (scripts/packages/). MuJoCo may also come
# from the Python wheel that scripts/setup unpacks. CMake does not download any library.
include_guard()
if(NOT DEFINED TRACKBED_MUJOCO AND EXISTS ${PROJECT_SOURCE_DIR}/build/mujoco)
  set(default_mujoco wheel)
else()
  set(default_mujoco debian)
endif()
set(TRACKBED_MUJOCO ${default_mujoco} CACHE STRING "MuJoCo: wheel, debian or a folder (cmake/Mujoco.cmake)")
include(LibraryDependencies)
include(MujocoVersion)

# EGL and FFmpeg are loaded at run time: the build needs only the headers of EGL and FFmpeg, and the
# tests also need the libraries.
find_package(PkgConfig REQUIRED)
pkg_check_modules(egl REQUIRED IMPORTED_TARGET egl)
add_library(egl::egl ALIAS PkgConfig::egl)
if(TRACKBED_VIDEO)
  pkg_check_modules(ffmpeg REQUIRED IMPORTED_TARGET libavformat libavcodec libswscale libavutil)
  add_library(ffmpeg::ffmpeg ALIAS PkgConfig::ffmpeg)
endif()

# trackbed_headers_of(TARGET LIBRARY): adds the library's include folders to the target, without
# linking the library.
function(trackbed_headers_of target library)
  target_include_directories(${target}
                             PRIVATE $<BUILD_INTERFACE:$<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>>)
endfunction()

find_package(CLI11 2 REQUIRED)

# The module `testing` consists of GoogleTest matchers and is built only if GoogleTest is found.
if(TRACKBED_BUILD_TESTS)
  find_package(GTest REQUIRED)
else()
  find_package(GTest QUIET)
endif()

# The benchmarks require OMPL. The tests compare results with OMPL only if OMPL is installed.
if(TRACKBED_BENCH)
  find_package(ompl REQUIRED CONFIG PATHS /usr/share/ompl/cmake)
elseif(TRACKBED_BUILD_TESTS)
  find_package(ompl QUIET CONFIG PATHS /usr/share/ompl/cmake)
endif()
if(ompl_FOUND)
  # Debian's OMPL 1.5.2 also lists libraries that only OMPL's own build needs.
  list(GET OMPL_LIBRARIES 0 ompl_library)
  add_library(ompl::ompl INTERFACE IMPORTED)
  target_link_libraries(ompl::ompl INTERFACE ${ompl_library})
  target_include_directories(ompl::ompl INTERFACE ${OMPL_INCLUDE_DIR})
endif()

# Finds the JavaScript libraries that reports contain, and their licenses.
macro(trackbed_find_script variable package file)
  find_file(${variable} ${file} PATHS ${ARGN} NO_DEFAULT_PATH)
  if(NOT ${variable})
    message(FATAL_ERROR "${file} is missing, which reports need: install Debian's ${package}")
  endif()
endmacro()
trackbed_find_script(D3_SCRIPT node-d3 d3.min.js /usr/share/nodejs/d3/dist)
trackbed_find_script(D3_LICENSE node-d3 copyright /usr/share/doc/node-d3)
trackbed_find_script(DYGRAPHS_SCRIPT libjs-dygraphs dygraph.min.js /usr/share/javascript/dygraphs)
trackbed_find_script(DYGRAPHS_STYLE libjs-dygraphs dygraph.min.css /usr/share/javascript/dygraphs)
trackbed_find_script(DYGRAPHS_LICENSE libjs-dygraphs copyright /usr/share/doc/libjs-dygraphs)
trackbed_find_script(THREE_SCRIPT libjs-three three.min.js /usr/share/javascript/three)
trackbed_find_script(ORBIT_CONTROLS_SCRIPT libjs-three OrbitControls.js
  /usr/share/javascript/three/examples/js/controls)
trackbed_find_script(THREE_LICENSE libjs-three copyright /usr/share/doc/libjs-three)
