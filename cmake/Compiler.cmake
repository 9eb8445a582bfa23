set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

# Linked by every target of the project.
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
            # Designated initializers may omit members with defaults.
            -Wno-missing-field-initializers
            # Clang reports a deprecated function that libstdc++'s stable_sort calls as a warning in our
            # sources. GCC still reports deprecated functions that our sources call.
            $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>
            # Debian 12's Boost 1.74 casts integers outside an enumeration's range, which is an
            # error for Clang 16 and later. Clang 20 no longer has the flag.
            $<$<AND:$<CXX_COMPILER_ID:Clang>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,16>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,20>>:-Wno-enum-constexpr-conversion>
            # The report page is one long string literal (ReportPage.cmake).
            $<$<CXX_COMPILER_ID:Clang>:-Wno-overlength-strings>
            # No fused multiply-add, so that the arithmetic is the same on every machine.
            -ffp-contract=off
            $<$<BOOL:${TRACKBED_WARNINGS_AS_ERRORS}>:-Werror>)
if(TRACKBED_FUZZ)
  # Adds Clang's coverage instrumentation for libFuzzer.
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
              # GCC 12 reports instrumented std::regex as uninitialized.
              $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(trackbed_compiler INTERFACE ${TRACKBED_SANITIZER_FLAGS})
endif()
