# Writes trackbed.pc for builds without CMake: the modules' link libraries in pkg-config syntax. A
# program that links static modules must also link all libraries that the modules use. To compile
# and link with shared modules, a program needs only the dependencies of their public headers.

set(mujoco -lmujoco)
if(TRACKBED_MUJOCO_FOLDER)
  set(folder \${libdir}/trackbed/mujoco/lib)
  set(mujoco "-L${folder} -Wl,-rpath,${folder} -lmujoco")
endif()

# Maps each library to its pkg-config name, or to linker options if no suitable .pc file exists, as
# for libcsv and MuJoCo. Boost is header-only. PROJ is linked by a linker option, because
# `pkg-config --static` with proj.pc would require libraries of curl that only static programs need.
set(pkg_config_names
    fmt::fmt=fmt
    Eigen3::Eigen=eigen3
    nlohmann_json::nlohmann_json=nlohmann_json
    NLopt::nlopt=nlopt
    ipopt::ipopt=-lipopt
    dlib::dlib=-ldlib
    yaml-cpp=yaml-cpp
    tinyxml2::tinyxml2=tinyxml2
    PROJ::proj=-lproj
    muparser::muparser=muparser
    PNG::PNG=libpng
    Boost::headers=
    Threads::Threads=-pthread
    TBB::tbb=tbb
    OpenSSL::Crypto=libcrypto
    csv::csv=-lcsv
    libzip::zip=libzip
    fastcdr=-lfastcdr
    SQLite::SQLite3=sqlite3
    lz4::lz4=liblz4
    zstd::zstd=libzstd
    "mujoco::mujoco=${mujoco}")

set(requires "")
set(external_libs "")
set(libs "")
foreach(module IN LISTS modules)
  string(REPLACE "/" "_" name ${module})
  if(module STREQUAL "testing")
    continue()
  endif()
  # The linker requires each library after the libraries that use it, so the modules are listed from
  # the top down.
  if(module STREQUAL "sim" AND NOT BUILD_SHARED_LIBS)
    list(PREPEND libs -ltrackbed_default_place)
  endif()
  list(PREPEND libs -ltrackbed_${name})
  if(BUILD_SHARED_LIBS)
    get_target_property(links trackbed_${name} INTERFACE_LINK_LIBRARIES)
  else()
    get_target_property(links trackbed_${name} LINK_LIBRARIES)
  endif()
  # Exclude from trackbed.pc Trackbed's own modules and the libraries that only Trackbed's own build
  # uses.
  list(FILTER links EXCLUDE REGEX "^trackbed_|^\\$<")
  foreach(library IN LISTS links)
    if(NOT ";${pkg_config_names};" MATCHES ";${library}=([^;]*);")
      message(FATAL_ERROR "cmake/PkgConfig.cmake does not know ${library}, which ${module} links")
    endif()
    set(pkg_config_name ${CMAKE_MATCH_1})
    if(pkg_config_name MATCHES "^-")
      list(APPEND external_libs ${pkg_config_name})
    else()
      list(APPEND requires ${pkg_config_name})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES requires)
list(REMOVE_DUPLICATES external_libs)
list(APPEND libs -ltrackbed_version ${external_libs})
list(JOIN requires " " requires)
list(JOIN libs " " libs)

set(pkg_config_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_file /${pkg_config_folder} /)
string(REGEX REPLACE "/$" "" prefix_from_file ${prefix_from_file})
configure_file(cmake/trackbed.pc.in package/trackbed.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/trackbed.pc DESTINATION ${pkg_config_folder})
