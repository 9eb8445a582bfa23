# Finds the dependencies of Trackbed's libraries, for Trackbed's own build and for projects that
# link the installed package. Projects that link Trackbed's shared libraries (trackbed_SHARED) need
# only the dependencies of public headers.
find_package(fmt REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost 1.74 REQUIRED CONFIG) # CMake 3.30 deprecates its own module
find_package(nlohmann_json 3.11 REQUIRED)
if(trackbed_SHARED)
  return()
endif()
find_package(yaml-cpp REQUIRED)
find_package(tinyxml2 REQUIRED)
find_package(PROJ 9 REQUIRED)
find_package(muparser 2.3 REQUIRED)
find_package(NLopt REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(OpenSSL 3 REQUIRED COMPONENTS Crypto)
find_package(PNG REQUIRED)
include(${CMAKE_CURRENT_LIST_DIR}/Mujoco.cmake)

# Defines the imported target TARGET for a library whose own package is not used. ARGN contains
# further arguments of find_path.
function(trackbed_find_library target header library)
  if(TARGET ${target})
    return()
  endif()
  string(REGEX REPLACE "::.*" "" prefix ${target})
  string(TOUPPER ${prefix} prefix)
  find_path(${prefix}_INCLUDE_DIR ${header} ${ARGN} REQUIRED)
  find_library(${prefix}_LIBRARY ${library} REQUIRED)
  add_library(${target} UNKNOWN IMPORTED)
  set_target_properties(${target} PROPERTIES IMPORTED_LOCATION ${${prefix}_LIBRARY}
                                             INTERFACE_INCLUDE_DIRECTORIES ${${prefix}_INCLUDE_DIR})
endfunction()

# IPOPT's pkg-config file is not used, because it requires libraries that only a static IPOPT needs.
if(TRACKBED_IPOPT)
  trackbed_find_library(ipopt::ipopt IpStdCInterface.h ipopt PATH_SUFFIXES coin coin-or)
endif()
# libzip's CMake package is not used, because it requires programs that Debian packages separately.
trackbed_find_library(libzip::zip zip.h zip)
# dlib's CMake package is not used, because it adds libraries that are not needed here, such as
# SQLite.
trackbed_find_library(dlib::dlib dlib/global_optimization.h dlib)
# libcsv has neither a pkg-config file nor a CMake package.
trackbed_find_library(csv::csv csv.h csv)
# Finds the libraries that read ROS 2 bags. The CMake package of zstd and the pkg-config file of lz4
# are not used, because not every Debian release has them.
find_package(fastcdr REQUIRED)
find_package(SQLite3 3.40 REQUIRED)
trackbed_find_library(lz4::lz4 lz4frame.h lz4)
trackbed_find_library(zstd::zstd zstd.h zstd)
