# BUILD_SHARED_LIBS=ON makes every module a separate shared library, libtrackbed_NAME.so, so that a
# program loads only the modules that it links. MuJoCo is loaded only with the module sim. All
# symbols are exported (default visibility), so that registries, exceptions and types exist once per
# process. The soname contains the minor version, like the package version: before 1.0, each minor
# version may break the ABI.
option(BUILD_SHARED_LIBS "Modules as shared libraries, not as static ones" OFF)

if(BUILD_SHARED_LIBS)
  # The build tree has the layout of the installation, because the module sim looks for the data
  # folder relative to its own shared library.
  set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR}/trackbed
       SYMBOLIC)
endif()

# Sets the run paths (RPATH) of the installed program and libraries, which are relative paths from
# one installed folder to another.
file(RELATIVE_PATH libraries_from_program /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set(TRACKBED_FMU_FROM_PROGRAM ${libraries_from_program}/trackbed)
set(TRACKBED_PROGRAM_RPATH "")
set(TRACKBED_LIBRARY_RPATH $ORIGIN)
if(BUILD_SHARED_LIBS)
  list(APPEND TRACKBED_PROGRAM_RPATH $ORIGIN/${libraries_from_program})
endif()
if(TRACKBED_MUJOCO_FOLDER)
  list(APPEND TRACKBED_PROGRAM_RPATH $ORIGIN/${libraries_from_program}/trackbed/mujoco/lib)
  list(APPEND TRACKBED_LIBRARY_RPATH $ORIGIN/trackbed/mujoco/lib)
endif()

# If mujoco_DIR selects MuJoCo, add MuJoCo's folder to the run paths; CMake never adds system
# folders.
if(NOT TRACKBED_MUJOCO_FOLDER)
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
endif()

# Sets the target properties that only shared libraries need; does nothing unless BUILD_SHARED_LIBS
# is ON.
function(trackbed_shared_properties target)
  if(NOT BUILD_SHARED_LIBS)
    return()
  endif()
  set_target_properties(
    ${target}
    PROPERTIES VERSION ${PROJECT_VERSION}
               SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
               INSTALL_RPATH "${TRACKBED_LIBRARY_RPATH}"
               DEFINE_SYMBOL "") # the headers have no export macros
  # Make the linker reject a library that uses symbols which none of its linked libraries defines.
  # The linker does not check undefined symbols with sanitizers, because Clang's sanitizer symbols
  # are in the program.
  if(NOT TRACKBED_SANITIZE)
    target_link_options(${target} PRIVATE LINKER:-z,defs)
  endif()
endfunction()
