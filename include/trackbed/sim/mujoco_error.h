#pragma once

struct mjLogMessage_;

namespace trackbed {

/// Turns errors of MuJoCo into exceptions: while an instance exists, an error inside MuJoCo throws
/// RunError in the thread that created the instance. MuJoCo's warnings in this thread are not
/// printed, but mjData still counts them. Without an instance, MuJoCo's default handlers write to
/// MUJOCO_LOG.TXT in the current folder, and an error ends the process. Before MuJoCo 3.10, the
/// error handler first waits for a key press on stdin.
///
/// Guarantees: other threads and the global handlers (mju_setLogHandler, mju_user_error,
/// mju_user_warning) are not affected. The destructor restores the thread's previous handlers.
/// Instances may be nested, and must be destroyed in the thread that created them, in reverse
/// order. The cost is a few nanoseconds.
class MujocoErrorScope {
 public:
  MujocoErrorScope();
  ~MujocoErrorScope();
  MujocoErrorScope(const MujocoErrorScope&) = delete;
  MujocoErrorScope& operator=(const MujocoErrorScope&) = delete;

 private:
  // The thread's previous handlers: a single handler since MuJoCo 3.10, two handlers before.
  void (*log_)(const mjLogMessage_*) = nullptr;
  void (*error_)(const char*) = nullptr;
  void (*warning_)(const char*) = nullptr;
};

}  // namespace trackbed
