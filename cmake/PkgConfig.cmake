# trackbed.pc, for builds without CMake: what the targets of the modules link, as pkg-config says it.
# A program that links static modules must link all that they use; one that links shared modules, and
# its compiler, need only what public headers include.

set(mujoco -lmujoco)
if(TRACKBED_MUJOCO_FOLDER)
  set(folder \${libdir}/trackbed/mujoco/lib)
  set(mujoco "-L${folder} -Wl,-rpath,${folder} -lmujoco")
endif()

# Names of pkg-config's, or options for the linker: libcsv and MuJoCo have no .pc file. Boost is
# headers. Of proj.pc, `--static` would want libraries of curl that only static programs need.
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
    "mujoco::mujoco=${mujoco}")

set(requires "")
set(external_libs "")
set(libs "")
foreach(module IN LISTS modules)
  string(REPLACE "/" "_" name ${module})
  if(module STREQUAL "testing")
    continue()
  endif()
  # The linker wants what is used after what uses it: the modules from the top down.
  if(module STREQUAL "sim" AND NOT BUILD_SHARED_LIBS)
    list(PREPEND libs -ltrackbed_default_place)
  endif()
  list(PREPEND libs -ltrackbed_${name})
  if(BUILD_SHARED_LIBS)
    get_target_property(links trackbed_${name} INTERFACE_LINK_LIBRARIES)
  else()
    get_target_property(links trackbed_${name} LINK_LIBRARIES)
  endif()
  # Without modules, and without what is only for Trackbed's own build.
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
