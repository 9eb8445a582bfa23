# Runs the program installed in WORK with the models and scenarios beside it.
set(program ${WORK}/installed/bin/trackbed)
set(data ${WORK}/installed/share/trackbed)
unset(ENV{TRACKBED_DATA})
file(REMOVE_RECURSE ${WORK}/elsewhere)
file(MAKE_DIRECTORY ${WORK}/elsewhere)

execute_process(
  COMMAND ${program} test ${data}/scenarios/winding.yaml --plant kinematic
  WORKING_DIRECTORY ${WORK}/elsewhere
  OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "^pass ${data}/scenarios/winding.yaml \\([0-9.]+ s\\): all expectations met[;\n]")
  message(FATAL_ERROR "the installed program says:\n${output}")
endif()
file(RENAME ${data}/models/prius ${data}/models/prius.away)
execute_process(COMMAND ${program} list models OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${data}/models/prius.away ${data}/models/prius)
if(output MATCHES "prius" OR NOT output MATCHES "bmw320i")
  message(FATAL_ERROR "without the installed prius there are:\n${output}")
endif()
foreach(page man/man1/trackbed-run.1 bash-completion/completions/trackbed
        zsh/site-functions/_trackbed fish/vendor_completions.d/trackbed.fish)
  file(SIZE ${WORK}/installed/share/${page} size)
  if(size LESS 500)
    message(FATAL_ERROR "${page} has ${size} bytes")
  endif()
endforeach()
