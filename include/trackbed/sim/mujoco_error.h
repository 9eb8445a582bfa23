#pragma once

struct mjLogMessage_;

namespace trackbed {

/// While an instance lives, an error inside MuJoCo throws RunError in the thread that created the
/// instance. MuJoCo's warnings in that thread are dropped, but mjData counts them. Without an
/// instance, MuJoCo's default handlers write to MUJOCO_LOG.TXT in the current folder and end the
/// process at an error. Before version 3.10, these handlers first wait for a key on stdin.
///
/// Guarantees: other threads and the global handlers (mju_setLogHandler, mju_user_error,
/// mju_user_warning) are not affected. The destructor restores the thread's previous handlers.
/// Scopes may be nested. Scopes must end in their thread, in reverse order of construction. Cost: a
/// few nanoseconds.
class MujocoErrorScope {
 public:
  MujocoErrorScope();
  ~MujocoErrorScope();
  MujocoErrorScope(const MujocoErrorScope&) = delete;
  MujocoErrorScope& operator=(const MujocoErrorScope&) = delete;

 private:
  // The previous handlers: one handler since MuJoCo 3.10, two before.
  void (*log_)(const mjLogMessage_*) = nullptr;
  void (*error_)(const char*) = nullptr;
  void (*warning_)(const char*) = nullptr;
};

}  // namespace trackbed
