#include "trackbed/sim/mujoco_error.h"

#include <mujoco/mujoco.h>

#include "trackbed/core/error.h"

// Handlers of the calling thread, which come before the global mju_user_error and mju_user_warning.
// The library exports them, for its Python bindings among others, but mujoco.h does not declare
// them.
extern "C" {
void (*_mjPRIVATE__get_tls_error_fn(void))(const char*);
void _mjPRIVATE__set_tls_error_fn(void (*handler)(const char*));
void (*_mjPRIVATE__get_tls_warning_fn(void))(const char*);
void _mjPRIVATE__set_tls_warning_fn(void (*handler)(const char*));
}

namespace trackbed {

MujocoErrorScope::MujocoErrorScope()
    : error_(_mjPRIVATE__get_tls_error_fn()), warning_(_mjPRIVATE__get_tls_warning_fn()) {
  _mjPRIVATE__set_tls_error_fn(
      [](const char* message) { throw RunError(fmt::format("MuJoCo: {}", message)); });
  _mjPRIVATE__set_tls_warning_fn([](const char*) {});
}

MujocoErrorScope::~MujocoErrorScope() {
  _mjPRIVATE__set_tls_error_fn(error_);
  _mjPRIVATE__set_tls_warning_fn(warning_);
}

}  // namespace trackbed
