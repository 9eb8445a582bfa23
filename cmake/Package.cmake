# `cpack -G DEB` in the build folder makes one Debian package of everything that `cmake --install`
# installs, for the Debian release on which the package is built. scripts/package builds Trackbed,
# makes the package and checks the package. docs/how-to/install.md describes the package for users.
#
# finish_package.cmake determines the dependencies of linked libraries with dpkg-shlibdeps.
# Package.cmake adds dependencies on the libraries that are loaded at run time for drawing and
# encoding, and suggests the packages that find_package(trackbed) needs.
find_program(DPKG_QUERY dpkg-query)
mark_as_advanced(DPKG_QUERY)
# Make a Debian package only of static libraries, because Debian requires separate packages for
# shared libraries.
if(NOT DPKG_QUERY OR BUILD_SHARED_LIBS)
  return()
endif()

# The package must contain the licenses of all code in the program and libraries. Boost's license
# does not require that its text accompanies compiled code.
set(carried_packages node-d3 libjs-dygraphs libjs-three libeigen3-dev nlohmann-json3-dev libcli11-dev)
foreach(package IN LISTS carried_packages)
  if(NOT EXISTS /usr/share/doc/${package}/copyright)
    message(STATUS "No cpack -G DEB: there is no /usr/share/doc/${package}/copyright")
    return()
  endif()
endforeach()

# trackbed_owner_of(LIBRARY VARIABLE): sets VARIABLE to the Debian package that owns lib<LIBRARY>.so, or to "".
function(trackbed_owner_of library variable)
  pkg_get_variable(folder lib${library} libdir)
  file(REAL_PATH ${folder}/lib${library}.so file)
  execute_process(COMMAND ${DPKG_QUERY} --search ${file} OUTPUT_VARIABLE owner ERROR_QUIET)
  if(owner MATCHES "^([^:, ]+)")
    set(${variable} ${CMAKE_MATCH_1} PARENT_SCOPE)
  else()
    message(STATUS "The package of cpack -G DEB will not depend on ${file}: dpkg does not know it")
    set(${variable} "" PARENT_SCOPE)
  endif()
endfunction()

# The package requires OSMesa, or EGL with Mesa's drivers. In the package's dependencies, a single
# list of alternatives cannot express "OSMesa, or both EGL and Mesa's drivers", but two lists can.
set(depends "libosmesa6 | libegl1" "libosmesa6 | libgl1-mesa-dri")
if(TRACKBED_VIDEO)
  foreach(library IN ITEMS avformat avcodec swscale avutil)
    trackbed_owner_of(${library} owner)
    list(APPEND depends ${owner}) # does nothing if `owner` is empty
  endforeach()
endif()
list(JOIN depends ", " CPACK_DEBIAN_PACKAGE_DEPENDS)

# Suggests the packages of the libraries that LibraryDependencies.cmake searches; the program runs
# without these packages.
set(suggests
    g++ libfmt-dev libeigen3-dev libboost-dev nlohmann-json3-dev libyaml-cpp-dev libtinyxml2-dev libproj-dev
    libmuparser-dev libnlopt-dev libnlopt-cxx-dev libssl-dev libpng-dev libdlib-dev libcsv-dev
    libfastcdr-dev libsqlite3-dev liblz4-dev libtbb-dev libzip-dev libzstd-dev)
if(TRACKBED_IPOPT)
  list(APPEND suggests coinor-libipopt-dev)
endif()
if(NOT TRACKBED_MUJOCO_FOLDER)
  list(APPEND suggests libmujoco-dev)
endif()
if(TARGET trackbed_testing)
  list(APPEND suggests libgmock-dev libgtest-dev)
endif()
list(JOIN suggests ", " CPACK_DEBIAN_PACKAGE_SUGGESTS)

# The package's version contains the Debian release, so that a package for Debian 13 replaces a
# package for Debian 12.
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
file(STRINGS /etc/os-release suite REGEX "^VERSION_ID=")
if(suite MATCHES "([0-9]+)")
  string(APPEND CPACK_DEBIAN_PACKAGE_VERSION +deb${CMAKE_MATCH_1})
endif()
set(TRACKBED_MAINTAINER "The Trackbed authors <trackbed@example.org>"
    CACHE STRING "Maintainer of the Debian package, with the address for its users")

set(carried "")
foreach(package IN LISTS carried_packages)
  configure_file(/usr/share/doc/${package}/copyright package/licenses/${package}.txt COPYONLY)
  string(APPEND carried "  licenses/${package}.txt\n")
endforeach()
if(TRACKBED_MUJOCO_FOLDER)
  string(APPEND carried "  mujoco/, of MuJoCo ${TRACKBED_MUJOCO_VERSION} and what it contains\n")
endif()
configure_file(packaging/copyright.in package/copyright @ONLY)

# Writes the changelog that Debian requires, which lists versions of the Debian package. Trackbed's
# own CHANGELOG.md is also installed.
set(changed "Thu, 01 Jan 1970 00:00:00 +0000")
if(GIT_EXECUTABLE)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${PROJECT_SOURCE_DIR} log -1 --format=%aD OUTPUT_VARIABLE committed
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(committed)
    set(changed ${committed})
  endif()
endif()
file(CONFIGURE OUTPUT package/changelog CONTENT [[trackbed (@CPACK_DEBIAN_PACKAGE_VERSION@) unstable; urgency=medium

  * See /usr/share/doc/trackbed/CHANGELOG.md.

 -- @TRACKBED_MAINTAINER@  @changed@
]] @ONLY)

# Pass to finish_package.cmake the folders with files that `cmake --install` does not install.
set(CPACK_TRACKBED_FILES ${PROJECT_BINARY_DIR}/package)
set(CPACK_TRACKBED_PACKAGING ${PROJECT_SOURCE_DIR}/packaging)

set(CPACK_PACKAGE_NAME trackbed)
set(CPACK_PACKAGE_CONTACT ${TRACKBED_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/finish_package.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
file(READ packaging/description.txt CPACK_DEBIAN_PACKAGE_DESCRIPTION)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
include(CPack)
