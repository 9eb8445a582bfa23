# BUILD_SHARED_LIBS=ON makes every module a separate shared library, libtrackbed_NAME.so, so that a
# program loads only the modules that it links, and MuJoCo only with sim. All symbols are exported
# (default visibility), so that registries, exceptions and types exist once per process. The soname
# contains the minor version, like the package version: before 1.0, each minor version may break the
# ABI.
option(BUILD_SHARED_LIBS "Modules as shared libraries, not as static ones" OFF)

if(BUILD_SHARED_LIBS)
  # The build tree has the layout of the installation, because sim looks for the data relative to
  # its library.
  set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR}/trackbed
       SYMBOLIC)
endif()

# Run paths of the installed program and libraries, relative to each other.
file(RELATIVE_PATH libraries_from_program /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set(TRACKBED_PROGRAM_RPATH "")
set(TRACKBED_LIBRARY_RPATH $ORIGIN)
if(BUILD_SHARED_LIBS)
  list(APPEND TRACKBED_PROGRAM_RPATH $ORIGIN/${libraries_from_program})
endif()
if(TRACKBED_MUJOCO_FOLDER)
  list(APPEND TRACKBED_PROGRAM_RPATH $ORIGIN/${libraries_from_program}/trackbed/mujoco/lib)
  list(APPEND TRACKBED_LIBRARY_RPATH $ORIGIN/trackbed/mujoco/lib)
endif()

# MuJoCo selected by mujoco_DIR is found at its location; run paths never contain system folders.
if(NOT TRACKBED_MUJOCO_FOLDER)
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
endif()

# Sets the properties of a library target that only shared libraries need.
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
  # The linker rejects a library with symbols that its own linked libraries do not define. This check
  # is off with sanitizers, because Clang's sanitizer symbols are in the program.
  if(NOT TRACKBED_SANITIZE)
    target_link_options(${target} PRIVATE LINKER:-z,defs)
  endif()
endfunction()
