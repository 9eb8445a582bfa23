#pragma once

#include <cstddef>

/// Counts the memory allocations of a test program that is linked with
/// --wrap=malloc --wrap=_Znwm. Include this header in one source of the program, because it defines
/// the functions to which the linker redirects malloc (which Eigen calls) and operator new. Does
/// not count allocations inside shared libraries such as NLopt.

namespace {

long allocations = 0;  // NOLINT: global, because it is counted in malloc

}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);   // NOLINT: the linker's names
void* __wrap_malloc(std::size_t size) {  // NOLINT
  ++allocations;
  return __real_malloc(size);
}
void* __real__Znwm(std::size_t size);   // NOLINT
void* __wrap__Znwm(std::size_t size) {  // NOLINT
  ++allocations;
  return __real__Znwm(size);
}
}
