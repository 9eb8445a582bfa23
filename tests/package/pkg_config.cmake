# Builds SOURCE, a program with a custom plant, without CMake: with the flags that pkg-config prints
# for the package installed in WORK, linked statically and dynamically. Runs SCENARIO.
set(installed ${WORK}/installed)
set(folder ${WORK}/pkg_config)
unset(ENV{TRACKBED_DATA})
set(ENV{PKG_CONFIG_PATH} ${installed}/${LIBDIR}/pkgconfig)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
separate_arguments(FLAGS)

# Sets OUTPUT to the list of words that `pkg-config ARGN trackbed` prints.
function(pkg_config output)
  execute_process(COMMAND pkg-config ${ARGN} trackbed OUTPUT_VARIABLE text
                  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(words UNIX_COMMAND "${text}")
  set(${output} ${words} PARENT_SCOPE)
endfunction()

# Runs the program NAME with TRACKBED_DATA set to DATA. It compares its plants on SCENARIO and must
# exit with CODE and print EXPECTED.
function(expect name data code expected)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env "TRACKBED_DATA=${data}" ${folder}/${name} compare ${SCENARIO}
    WORKING_DIRECTORY ${folder} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL code OR NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${name}, data '${data}'\nexpected ${code} and '${expected}', was ${result} and\n${output}")
  endif()
endfunction()

pkg_config(version --modversion)
if(NOT version STREQUAL VERSION)
  message(FATAL_ERROR "the version is ${version}, not ${VERSION}")
endif()
pkg_config(cflags --cflags)
execute_process(COMMAND ${COMPILER} -std=c++20 ${FLAGS} ${cflags} -c ${SOURCE} -o program.o
                WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
pkg_config(libdir --variable=libdir)
pkg_config(data --variable=pkgdatadir)
set(options_of_static --static)
foreach(kind IN ITEMS dynamic static)
  pkg_config(libs --libs ${options_of_${kind}})
  execute_process(COMMAND ${COMPILER} ${FLAGS} program.o ${libs} -Wl,-rpath,${libdir} -o ${kind}
                  WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
  expect(${kind} "${data}" 0 "kinematic - lagging")
  if(SHARED)
    expect(${kind} "" 0 "kinematic - lagging")
  else()
    expect(${kind} "" 2 "set the environment variable TRACKBED_DATA")
  endif()
endforeach()
