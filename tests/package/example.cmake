# Configures, builds and runs the example project EXAMPLE from an empty folder against the package
# installed in WORK. The example must use the installed cars: without them it must fail.
set(installed ${WORK}/installed)
set(folder ${WORK}/example)
unset(ENV{TRACKBED_DATA})
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${EXAMPLE} -B ${folder} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${installed}
          -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
          -DCMAKE_CXX_FLAGS=${FLAGS}
  WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${folder} COMMAND_ERROR_IS_FATAL ANY)

set(models ${installed}/share/trackbed/models)
file(RENAME ${models} ${models}.away)
execute_process(COMMAND ${folder}/compare_test RESULT_VARIABLE code OUTPUT_VARIABLE output
                ERROR_VARIABLE output)
file(RENAME ${models}.away ${models})
if(code EQUAL 0 OR NOT output MATCHES "unknown model 'prius'")
  message(FATAL_ERROR "without the installed models the example says (${code}):\n${output}")
endif()

execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${folder} --output-on-failure
                OUTPUT_VARIABLE output COMMAND_ECHO STDOUT ECHO_OUTPUT_VARIABLE
                COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "100% tests passed, 0 tests failed out of 4")
  message(FATAL_ERROR "expected four tests")
endif()
if(NOT EXISTS ${folder}/corner.xml)
  message(FATAL_ERROR "no JUnit report of the scenarios")
endif()
