# Configures the project `components`, then builds and runs its program of one module, which must
# not load libraries that only other modules need. The package is the one installed in WORK.
set(folder ${WORK}/components)
file(REMOVE_RECURSE ${folder})
execute_process(
  COMMAND
    ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/components -B ${folder} -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${WORK}/installed -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS}
    -DVERSION=${VERSION} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${folder} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${folder}/pose COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ldd ${folder}/pose OUTPUT_VARIABLE loaded COMMAND_ERROR_IS_FATAL ANY)
if(loaded MATCHES "mujoco")
  message(FATAL_ERROR "a program of trackbed::core loads\n${loaded}")
endif()
# Libraries that draw and encode are loaded on first use; otherwise every verb would wait for them.
execute_process(COMMAND ldd ${WORK}/installed/${BINDIR}/trackbed OUTPUT_VARIABLE loaded
                COMMAND_ERROR_IS_FATAL ANY)
if(loaded MATCHES "OSMesa|EGL|LLVM|avcodec|x264")
  message(FATAL_ERROR "the program loads at its start\n${loaded}")
endif()
