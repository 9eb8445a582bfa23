# Configures and builds the example project EXAMPLE from an empty folder against the package
# installed in WORK, and runs COMMANDS, lists separated by `|`, with the resulting program.
set(installed ${WORK}/installed)
get_filename_component(name ${EXAMPLE} NAME)
set(folder ${WORK}/${name})
unset(ENV{TRACKBED_DATA})
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${EXAMPLE} -B ${folder} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${installed}
          -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
          -DCMAKE_CXX_FLAGS=${FLAGS}
  WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${folder} COMMAND_ERROR_IS_FATAL ANY)

# Runs the program with ARGN and checks its exit code and output.
function(expect code expected)
  execute_process(COMMAND ${folder}/${PROGRAM} ${ARGN} WORKING_DIRECTORY ${folder}
                  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL code OR NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${PROGRAM} ${ARGN}\nexpected ${code} and '${expected}', was ${result} and\n${output}")
  endif()
endfunction()

if(name STREQUAL own-methods)
  set(PROGRAM own_trackbed)
  expect(0 "sidestep +an S to the lane on the left; offset: 3.5, radius: 15" list planners)
  expect(0 "feedforward +path curvature with proportional feedback; time: 2, distance: 6" list controllers)
  expect(0 "turn: 0\\.45103 rad" plan ${EXAMPLE}/sidestep.yaml)
  expect(0 "passed" run ${EXAMPLE}/sidestep.yaml)
  expect(0 "all expectations met" test ${EXAMPLE}/sidestep.yaml)
  expect(0 "kinematic" compare ${EXAMPLE}/sidestep.yaml)
  # On a flat road, the kinematic car does not roll.
  expect(0 "passed" run ${EXAMPLE}/sidestep.yaml --set drive.plants=[kinematic]
         --set "expect.metrics=[{metric: roll_max, max: 0}]")
  expect(2 "unknown metric 'roll_mac'; did you mean 'roll_max'" run ${EXAMPLE}/sidestep.yaml
         --set "expect.metrics=[{metric: roll_mac, max: 0}]")
  expect(0 "" sweep ${EXAMPLE}/distances.yaml --out study)
  expect(0 "" report out/sidestep -o sidestep.html)
  expect(2 "unknown 'sidestap'; did you mean 'sidestep'" run ${EXAMPLE}/sidestep.yaml --set plan.method=sidestap)
  expect(2 "plan.offset: .*above 0" run ${EXAMPLE}/sidestep.yaml --set plan.offset=-1)
  expect(2 "unknown key 'distanc'; did you mean 'distance'" run ${EXAMPLE}/sidestep.yaml --set control.distanc=1)
  foreach(file study/sweep.csv sidestep.html)
    if(NOT EXISTS ${folder}/${file})
      message(FATAL_ERROR "there is no ${file}")
    endif()
  endforeach()
elseif(name STREQUAL first-program)
  set(PROGRAM first_program)
  expect(0 "kinematic: [0-9]+ rows, largest cross-track error 0[.]2[0-9]+ m.*mujoco: .*at most 0[.]0[0-9]+ m apart")
else()
  set(PROGRAM own_plant)
  expect(0 "lagging +the kinematic car behind a slow power steering" list plants)
  expect(0 "lagging" compare ${EXAMPLE}/slow_steering.yaml)
  expect(2 "did you mean 'lagging'" run ${EXAMPLE}/slow_steering.yaml --set "drive.plants=[laging]")
endif()
