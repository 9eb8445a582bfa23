#include "trackbed/sim/mujoco_error.h"

#include <mujoco/mujoco.h>

#include "trackbed/core/error.h"

// Functions of MuJoCo that set the error and warning handlers of the calling thread. In MuJoCo, the
// handlers of a thread take precedence over the global handlers. MuJoCo exports these functions,
// for example for its Python bindings, but mujoco.h does not declare them.
extern "C" {
#if mjVERSION_HEADER >= 3010000
// each function returns the thread's previous handler
mjfLogHandler _mjPRIVATE_setTlsLogHandler(mjfLogHandler handler);
#else
void (*_mjPRIVATE__get_tls_error_fn(void))(const char*);
void _mjPRIVATE__set_tls_error_fn(void (*handler)(const char*));
void (*_mjPRIVATE__get_tls_warning_fn(void))(const char*);
void _mjPRIVATE__set_tls_warning_fn(void (*handler)(const char*));
#endif
}

namespace trackbed {

#if mjVERSION_HEADER >= 3010000

namespace {

void ThrowErrors(const mjLogMessage* message) {
  if (message->level == mjLOG_ERROR) {
    const char* function = message->func == nullptr ? "" : message->func;
    throw RunError(fmt::format("MuJoCo: {}{}{}", function, *function == '\0' ? "" : ": ",
                               static_cast<const char*>(message->subject)));
  }
}

}  // namespace

MujocoErrorScope::MujocoErrorScope() : log_(_mjPRIVATE_setTlsLogHandler(ThrowErrors)) {}

MujocoErrorScope::~MujocoErrorScope() {
  _mjPRIVATE_setTlsLogHandler(log_);
}

#else

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

#endif

}  // namespace trackbed
