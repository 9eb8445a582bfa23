# Checks that the headers and the library of mujoco::mujoco have the same version, and rejects
# versions that Trackbed does not support. Sets TRACKBED_MUJOCO_VERSION.
# docs/how-to/mujoco-versions.md lists the differences between the MuJoCo versions.
set(program ${PROJECT_BINARY_DIR}/mujoco_version/version.cpp)
file(CONFIGURE OUTPUT ${program} CONTENT [[#include <mujoco/mujoco.h>

#include <cstdio>

int main() {
  std::printf("%d %d %s", mjVERSION_HEADER, mj_version(), mj_versionString());
}
]] @ONLY)
try_run(mujoco_version_exit mujoco_version_compiles ${PROJECT_BINARY_DIR}/mujoco_version ${program}
        LINK_LIBRARIES mujoco::mujoco
        COMPILE_OUTPUT_VARIABLE compile_output RUN_OUTPUT_VARIABLE versions)
if(NOT mujoco_version_compiles OR NOT versions MATCHES "^([0-9]+) ([0-9]+) ([0-9.]+)$")
  message(FATAL_ERROR "MuJoCo does not compile, link or start:\n${compile_output}${versions}")
endif()
set(mujoco_headers ${CMAKE_MATCH_1})
set(mujoco_library ${CMAKE_MATCH_2})
set(TRACKBED_MUJOCO_VERSION ${CMAKE_MATCH_3})
# Repeat the check of MuJoCo's version at each configuration, because MuJoCo's library may have been
# replaced.
unset(mujoco_version_exit CACHE)
unset(mujoco_version_compiles CACHE)
if(NOT mujoco_headers EQUAL mujoco_library)
  message(FATAL_ERROR "MuJoCo's headers are of version ${mujoco_headers}, its library of ${mujoco_library}: "
                      "install both of one version, or set TRACKBED_MUJOCO")
endif()
if(TRACKBED_MUJOCO_VERSION VERSION_EQUAL 4.0.0)
  message(FATAL_ERROR "MuJoCo 4.0.0 computes wrong accelerations (its sparse Cholesky factor): use 4.0.1")
elseif(NOT TRACKBED_MUJOCO_VERSION VERSION_EQUAL 2.2.2 AND TRACKBED_MUJOCO_VERSION VERSION_LESS 3.3)
  message(FATAL_ERROR "MuJoCo ${TRACKBED_MUJOCO_VERSION} is not supported: use 2.2.2, 3.3 or newer")
endif()
message(STATUS "MuJoCo ${TRACKBED_MUJOCO_VERSION}")
