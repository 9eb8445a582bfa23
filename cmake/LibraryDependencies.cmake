# Finds the dependencies of Trackbed's libraries, for Trackbed's own build and for projects that
# link the installed package. Projects that link shared libraries (trackbed_SHARED) need only the
# dependencies of public headers.
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
find_package(OpenSSL 3 REQUIRED COMPONENTS Crypto)
find_package(PNG REQUIRED)
include(${CMAKE_CURRENT_LIST_DIR}/Mujoco.cmake)

# IPOPT's pkg-config file is not used, because it requires libraries that only a static IPOPT needs.
if(TRACKBED_IPOPT AND NOT TARGET ipopt::ipopt)
  find_path(IPOPT_INCLUDE_DIR IpStdCInterface.h PATH_SUFFIXES coin coin-or REQUIRED)
  find_library(IPOPT_LIBRARY ipopt REQUIRED)
  add_library(ipopt::ipopt UNKNOWN IMPORTED)
  set_target_properties(ipopt::ipopt PROPERTIES IMPORTED_LOCATION ${IPOPT_LIBRARY}
                                                INTERFACE_INCLUDE_DIRECTORIES ${IPOPT_INCLUDE_DIR})
endif()

# libzip's CMake package is not used, because it requires programs that Debian packages separately.
if(NOT TARGET libzip::zip)
  find_path(ZIP_INCLUDE_DIR zip.h REQUIRED)
  find_library(ZIP_LIBRARY zip REQUIRED)
  add_library(libzip::zip UNKNOWN IMPORTED)
  set_target_properties(libzip::zip PROPERTIES IMPORTED_LOCATION ${ZIP_LIBRARY}
                                               INTERFACE_INCLUDE_DIRECTORIES ${ZIP_INCLUDE_DIR})
endif()

# dlib's CMake package is not used, because it adds libraries that are not needed here, such as
# SQLite.
if(NOT TARGET dlib::dlib)
  find_path(DLIB_INCLUDE_DIR dlib/global_optimization.h REQUIRED)
  find_library(DLIB_LIBRARY dlib REQUIRED)
  add_library(dlib::dlib UNKNOWN IMPORTED)
  set_target_properties(dlib::dlib PROPERTIES IMPORTED_LOCATION ${DLIB_LIBRARY}
                                              INTERFACE_INCLUDE_DIRECTORIES ${DLIB_INCLUDE_DIR})
endif()

# libcsv has neither a pkg-config file nor a CMake package.
if(NOT TARGET csv::csv)
  find_path(CSV_INCLUDE_DIR csv.h REQUIRED)
  find_library(CSV_LIBRARY csv REQUIRED)
  add_library(csv::csv UNKNOWN IMPORTED)
  set_target_properties(csv::csv PROPERTIES IMPORTED_LOCATION ${CSV_LIBRARY}
                                            INTERFACE_INCLUDE_DIRECTORIES ${CSV_INCLUDE_DIR})
endif()

# Libraries that read bags of ROS 2. The CMake package of zstd and the pkg-config file of lz4 are not
# used, because not every Debian release has them.
find_package(fastcdr REQUIRED)
find_package(SQLite3 3.40 REQUIRED)
if(NOT TARGET lz4::lz4)
  find_path(LZ4_INCLUDE_DIR lz4frame.h REQUIRED)
  find_library(LZ4_LIBRARY lz4 REQUIRED)
  add_library(lz4::lz4 UNKNOWN IMPORTED)
  set_target_properties(lz4::lz4 PROPERTIES IMPORTED_LOCATION ${LZ4_LIBRARY}
                                            INTERFACE_INCLUDE_DIRECTORIES ${LZ4_INCLUDE_DIR})
endif()
if(NOT TARGET zstd::zstd)
  find_path(ZSTD_INCLUDE_DIR zstd.h REQUIRED)
  find_library(ZSTD_LIBRARY zstd REQUIRED)
  add_library(zstd::zstd UNKNOWN IMPORTED)
  set_target_properties(zstd::zstd PROPERTIES IMPORTED_LOCATION ${ZSTD_LIBRARY}
                                              INTERFACE_INCLUDE_DIRECTORIES ${ZSTD_INCLUDE_DIR})
endif()
