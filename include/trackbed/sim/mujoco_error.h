#pragma once

struct mjLogMessage_;

namespace trackbed {

/// Converts errors of MuJoCo to exceptions. While a MujocoErrorScope exists, an error inside MuJoCo
/// throws RunError in the thread that created the scope. While a MujocoErrorScope exists, MuJoCo's
/// warnings in the same thread are not printed, but are still counted in mjData. Without a
/// MujocoErrorScope, MuJoCo's default handlers write to MUJOCO_LOG.TXT in the current folder, and
/// an error ends the process. Before MuJoCo 3.10, the default error handler first waits for a key
/// press on stdin.
///
/// Guarantees: other threads and the global handlers (mju_setLogHandler, mju_user_error,
/// mju_user_warning) are not affected. The destructor of MujocoErrorScope restores the thread's
/// previous MuJoCo error handlers. Instances of MujocoErrorScope may be nested, and must be
/// destroyed in the thread that created them, in reverse order. Making and destroying a
/// MujocoErrorScope takes a few nanoseconds.
class MujocoErrorScope {
 public:
  MujocoErrorScope();
  ~MujocoErrorScope();
  MujocoErrorScope(const MujocoErrorScope&) = delete;
  MujocoErrorScope& operator=(const MujocoErrorScope&) = delete;

 private:
  // MuJoCo's error handlers of the thread before this scope: one handler since MuJoCo 3.10, two in
  // older versions.
  [[maybe_unused]] void (*log_)(const mjLogMessage_*) = nullptr;
  [[maybe_unused]] void (*error_)(const char*) = nullptr;
  [[maybe_unused]] void (*warning_)(const char*) = nullptr;
};

}  // namespace trackbed
