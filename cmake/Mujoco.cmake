# Defines the target mujoco::mujoco, for Trackbed's build and for projects that link the package.
# The variable TRACKBED_MUJOCO selects the MuJoCo:
#
#   TRACKBED_MUJOCO  wheel: the release of scripts/packages/mujoco.txt, which scripts/setup unpacks
#                      below build/
#                    debian: find_package(mujoco CONFIG): Debian's libmujoco-dev, or the package
#                      that mujoco_DIR or CMAKE_PREFIX_PATH selects
#                    a folder: an unpacked release archive, or any folder with
#                      include/mujoco/mujoco.h and lib/libmujoco.so.
#
# Sets TRACKBED_MUJOCO_FOLDER to the folder of the wheel or the archive, which `cmake --install`
# copies; TRACKBED_MUJOCO_FOLDER is empty for the system's MuJoCo.

# Defines the target mujoco::mujoco with the headers and the library in the folder `root`.
function(trackbed_mujoco_of root)
  file(GLOB libraries ${root}/lib/libmujoco.so.*.*.* ${root}/lib/libmujoco.so)
  if(NOT libraries OR NOT EXISTS ${root}/include/mujoco/mujoco.h)
    message(FATAL_ERROR "TRACKBED_MUJOCO: ${root} has no include/mujoco/mujoco.h or no lib/libmujoco.so; "
                        "must be wheel, debian, or the folder of an unpacked release of MuJoCo")
  endif()
  list(GET libraries 0 library)
  add_library(mujoco::mujoco SHARED IMPORTED)
  set_target_properties(mujoco::mujoco PROPERTIES IMPORTED_LOCATION ${library}
                                                  INTERFACE_INCLUDE_DIRECTORIES ${root}/include)
endfunction()

set(TRACKBED_MUJOCO_FOLDER "")
if(TARGET mujoco::mujoco)
  # The including project may already have defined the target mujoco::mujoco; this file then does
  # nothing.
elseif(TRACKBED_MUJOCO STREQUAL "debian")
  find_package(mujoco CONFIG QUIET)
  if(NOT mujoco_FOUND)
    message(FATAL_ERROR "TRACKBED_MUJOCO=debian: no CMake package mujoco; install Debian's libmujoco-dev, "
                        "or set mujoco_DIR")
  endif()
  # Debian's MuJoCo 2.2.2 exports an include folder of libqhull-dev that may not exist; CMake would
  # reject the target because of the missing folder.
  get_target_property(folders mujoco::mujoco INTERFACE_INCLUDE_DIRECTORIES)
  set(existing "")
  foreach(folder IN LISTS folders)
    if(EXISTS ${folder})
      list(APPEND existing ${folder})
    endif()
  endforeach()
  set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${existing}")
else()
  if(TRACKBED_MUJOCO STREQUAL "wheel")
    file(STRINGS ${PROJECT_SOURCE_DIR}/scripts/packages/mujoco.txt pinned REGEX "^mujoco-core==")
    string(REGEX REPLACE "^mujoco-core==([0-9.]+).*" "${PROJECT_SOURCE_DIR}/build/mujoco/\\1"
           TRACKBED_MUJOCO_FOLDER "${pinned}")
    if(NOT EXISTS ${TRACKBED_MUJOCO_FOLDER})
      message(FATAL_ERROR "TRACKBED_MUJOCO=wheel: no ${TRACKBED_MUJOCO_FOLDER}; run scripts/setup")
    endif()
  else()
    get_filename_component(TRACKBED_MUJOCO_FOLDER ${TRACKBED_MUJOCO} ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
  endif()
  trackbed_mujoco_of(${TRACKBED_MUJOCO_FOLDER})
endif()
