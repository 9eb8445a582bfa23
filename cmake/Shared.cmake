# BUILD_SHARED_LIBS=ON makes every module a shared library of its own, libtrackbed_NAME.so, so that a
# program loads only the modules that it links, and MuJoCo only with sim. All symbols are exported
# (default visibility): registries, exceptions and types are then one per process.
# The soname has the minor version, as the package version has: before 1.0 each may break the ABI.
option(BUILD_SHARED_LIBS "Modules as shared libraries, not as static ones" OFF)

if(BUILD_SHARED_LIBS)
  # The build tree has the layout of the installed one, where sim looks for the data beside itself.
  set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR}/trackbed
       SYMBOLIC)
endif()

# Where the installed program and libraries look for those that are installed with them.
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

# MuJoCo that mujoco_DIR leads to is found where it lies; folders of the system are in no runpath.
if(NOT TRACKBED_MUJOCO_FOLDER)
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
endif()

# What a library target has only as a shared one.
function(trackbed_shared_properties target)
  if(NOT BUILD_SHARED_LIBS)
    return()
  endif()
  set_target_properties(
    ${target}
    PROPERTIES VERSION ${PROJECT_VERSION}
               SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
               INSTALL_RPATH "${TRACKBED_LIBRARY_RPATH}"
               DEFINE_SYMBOL "") # there are no export macros
  # A library that uses what it does not link is refused. Clang's sanitizers are symbols of the
  # program.
  if(NOT TRACKBED_SANITIZE)
    target_link_options(${target} PRIVATE LINKER:-z,defs)
  endif()
endfunction()
