# Tests that cmake/Mujoco.cmake and cmake/MujocoVersion.cmake accept supported versions of MuJoCo
# and reject the others with the right reason. Each test MuJoCo is a header and a library that
# contain only their versions.
file(REMOVE_RECURSE ${WORK})

# Creates a release in WORK/NAME with these versions of headers and library.
function(make_release name header library text)
  set(folder ${WORK}/${name})
  file(WRITE ${folder}/include/mujoco/mujoco.h
       "#define mjVERSION_HEADER ${header}\nextern \"C\" int mj_version(void);\nextern \"C\" const char* mj_versionString(void);\n")
  file(WRITE ${folder}/mujoco.cpp
       "extern \"C\" int mj_version() { return ${library}; }\nextern \"C\" const char* mj_versionString() { return \"${text}\"; }\n")
  file(MAKE_DIRECTORY ${folder}/lib)
  execute_process(COMMAND ${COMPILER} -shared -fPIC ${folder}/mujoco.cpp -o ${folder}/lib/libmujoco.so
                  COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Configures a project with TRACKBED_MUJOCO set to `mujoco`: it must succeed or fail, and print
# `expected`.
function(expect mujoco succeeds expected)
  file(WRITE ${WORK}/project/CMakeLists.txt "cmake_minimum_required(VERSION 3.24)
project(versions LANGUAGES CXX)
include(${SOURCE}/cmake/Mujoco.cmake)
include(${SOURCE}/cmake/MujocoVersion.cmake)
")
  file(REMOVE_RECURSE ${WORK}/build)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${WORK}/project -B ${WORK}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
            -DTRACKBED_MUJOCO=${mujoco}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  string(FIND "${output}" "${expected}" place)
  if((succeeds AND NOT result EQUAL 0) OR (NOT succeeds AND result EQUAL 0) OR place EQUAL -1)
    message(FATAL_ERROR "${mujoco}: expected '${expected}', was ${result} and\n${output}")
  endif()
endfunction()

make_release(old 222 222 2.2.2)
expect(${WORK}/old YES "-- MuJoCo 2.2.2")
make_release(new 4000001 4000001 4.0.1)
expect(${WORK}/new YES "-- MuJoCo 4.0.1")
make_release(middle 330 330 3.3.0)
expect(${WORK}/middle YES "-- MuJoCo 3.3.0")
make_release(between 320 320 3.2.0)
expect(${WORK}/between NO "MuJoCo 3.2.0 is not supported: use 2.2.2, 3.3 or newer")
make_release(wrong 4000000 4000000 4.0.0)
expect(${WORK}/wrong NO "MuJoCo 4.0.0 computes wrong accelerations")
make_release(mixed 222 4000001 4.0.1)
expect(${WORK}/mixed NO "MuJoCo's headers are of version 222, its library of 4000001")
expect(${WORK}/nowhere NO "has no include/mujoco/mujoco.h or no lib/libmujoco.so")
