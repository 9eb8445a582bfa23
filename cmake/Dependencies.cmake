# Everything comes from Debian (scripts/packages.txt); nothing is downloaded.
include_guard()

find_package(fmt REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost 1.74 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(tinyxml2 REQUIRED)
find_package(CLI11 2 REQUIRED)
find_package(NLopt REQUIRED)
find_package(GTest REQUIRED)  # the testing room is a library of matchers, not only our own tests
find_package(PNG REQUIRED)
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)

find_package(mujoco REQUIRED CONFIG)
# Debian's 2.2.2 exports an include directory of libqhull, which it only needs to be built itself.
set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "")

pkg_check_modules(osmesa REQUIRED IMPORTED_TARGET osmesa)
add_library(osmesa::osmesa ALIAS PkgConfig::osmesa)
if(TRACKBED_VIDEO)
  pkg_check_modules(ffmpeg REQUIRED IMPORTED_TARGET libavformat libavcodec libswscale libavutil)
  add_library(ffmpeg::ffmpeg ALIAS PkgConfig::ffmpeg)
endif()

# A peer: benchmarks need it, tests compare with it where it is.
if(TRACKBED_BENCH)
  find_package(ompl REQUIRED CONFIG PATHS /usr/share/ompl/cmake)
elseif(TRACKBED_BUILD_TESTS)
  find_package(ompl QUIET CONFIG PATHS /usr/share/ompl/cmake)
endif()
if(ompl_FOUND)
  # Debian's 1.5.2 also lists what it only needs to be built itself.
  list(GET OMPL_LIBRARIES 0 ompl_library)
  add_library(ompl::ompl INTERFACE IMPORTED)
  target_link_libraries(ompl::ompl INTERFACE ${ompl_library})
  target_include_directories(ompl::ompl INTERFACE ${OMPL_INCLUDE_DIR})
endif()

# libcsv ships neither a pkg-config file nor a CMake package.
find_path(CSV_INCLUDE_DIR csv.h REQUIRED)
find_library(CSV_LIBRARY csv REQUIRED)
add_library(csv::csv UNKNOWN IMPORTED)
set_target_properties(csv::csv PROPERTIES IMPORTED_LOCATION ${CSV_LIBRARY}
                                          INTERFACE_INCLUDE_DIRECTORIES ${CSV_INCLUDE_DIR})

# JavaScript that the reports carry with them, and its licences.
macro(trackbed_find_script variable package file)
  find_file(${variable} ${file} PATHS ${ARGN} NO_DEFAULT_PATH)
  if(NOT ${variable})
    message(FATAL_ERROR "${file} is missing, which reports need: install Debian's ${package}")
  endif()
endmacro()
trackbed_find_script(D3_SCRIPT node-d3 d3.min.js /usr/share/nodejs/d3/dist)
trackbed_find_script(D3_LICENCE node-d3 copyright /usr/share/doc/node-d3)
trackbed_find_script(DYGRAPHS_SCRIPT libjs-dygraphs dygraph.min.js /usr/share/javascript/dygraphs)
trackbed_find_script(DYGRAPHS_STYLE libjs-dygraphs dygraph.min.css /usr/share/javascript/dygraphs)
trackbed_find_script(DYGRAPHS_LICENCE libjs-dygraphs copyright /usr/share/doc/libjs-dygraphs)
