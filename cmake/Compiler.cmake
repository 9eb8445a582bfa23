set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

# Defines trackbed_compiler, the compiler options with which every target of the project is built.
add_library(trackbed_compiler INTERFACE)
target_compile_options(
  trackbed_compiler
  INTERFACE -Wall
            -Wextra
            -Wpedantic
            -Wshadow
            -Wconversion
            -Wsign-conversion
            -Wold-style-cast
            -Wnon-virtual-dtor
            -Woverloaded-virtual
            -Wimplicit-fallthrough
            # Allow designated initializers that omit members with default values.
            -Wno-missing-field-initializers
            # Turn off Clang's warning about deprecated functions, because Clang also reports a
            # deprecated function that is called inside stable_sort of libstdc++. GCC still reports
            # the deprecated functions that Trackbed's sources call.
            $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>
            # Debian 12's Boost 1.74 casts integers outside an enumeration's range, which is an
            # error for Clang 16 and later. Clang 20 no longer has a flag to turn off the error
            # about such casts.
            $<$<AND:$<CXX_COMPILER_ID:Clang>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,16>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,20>>:-Wno-enum-constexpr-conversion>
            # Allow long string literals, because the report page is a single literal
            # (ReportPage.cmake).
            $<$<CXX_COMPILER_ID:Clang>:-Wno-overlength-strings>
            # Disable fused multiply-add instructions, so that floating-point results are the same
            # on every machine.
            -ffp-contract=off
            $<$<BOOL:${TRACKBED_WARNINGS_AS_ERRORS}>:-Werror>)
# GCC collects garbage whenever its memory has doubled, beginning at 128 MB. These collections take an
# eighth of the compile time, and a group of sources needs 1 to 2 GB with or without collections.
cmake_host_system_information(RESULT memory_mb QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory_each "${memory_mb} / ${processors}")
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND memory_each GREATER 3000)
  target_compile_options(trackbed_compiler INTERFACE --param=ggc-min-heapsize=2000000)
endif()
# Compiler options of all modules, whose code is position-independent. No program replaces a
# function of a module at load time, so the compiler may inline the calls inside a module, as in
# other code.
set(TRACKBED_POSITION_INDEPENDENT -fno-semantic-interposition)
if(TRACKBED_FUZZ)
  # Instruments the code with Clang's coverage counters, which libFuzzer needs.
  target_compile_options(
    trackbed_compiler INTERFACE -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
                                -fno-omit-frame-pointer)
  target_link_options(trackbed_compiler INTERFACE -fsanitize=address,undefined)
endif()
set(TRACKBED_SANITIZER_FLAGS "")
if(TRACKBED_SANITIZE)
  if(NOT TRACKBED_SANITIZE MATCHES "^(address|thread)$")
    message(FATAL_ERROR "TRACKBED_SANITIZE is '${TRACKBED_SANITIZE}'; must be OFF, address or thread")
  endif()
  string(REPLACE address address,undefined TRACKBED_SANITIZER_FLAGS -fsanitize=${TRACKBED_SANITIZE})
  target_compile_options(
    trackbed_compiler
    INTERFACE ${TRACKBED_SANITIZER_FLAGS}
              -fno-sanitize-recover=all
              -fno-omit-frame-pointer
              # With sanitizers, GCC 12 wrongly reports uninitialized variables in std::regex.
              $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(trackbed_compiler INTERFACE ${TRACKBED_SANITIZER_FLAGS})
endif()
