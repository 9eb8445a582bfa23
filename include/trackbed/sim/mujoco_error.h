#pragma once

struct mjLogMessage_;

namespace trackbed {

/// While one lives, an error inside MuJoCo throws RunError in the thread that made it, and MuJoCo's
/// warnings there are dropped (mjData counts them). Without it, MuJoCo's own handlers write to
/// MUJOCO_LOG.TXT in the current folder and end the process at an error; before 3.10 they first
/// wait for a key on stdin.
///
/// Guarantees: affects no other thread and none of the global handlers (mju_setLogHandler,
/// mju_user_error, mju_user_warning); afterwards the thread has the handlers it had before. Scopes
/// nest, and end in the thread and in the reverse order in which they began. Cost: a few
/// nanoseconds.
class MujocoErrorScope {
 public:
  MujocoErrorScope();
  ~MujocoErrorScope();
  MujocoErrorScope(const MujocoErrorScope&) = delete;
  MujocoErrorScope& operator=(const MujocoErrorScope&) = delete;

 private:
  // The handlers before: one of all messages since MuJoCo 3.10, two before.
  void (*log_)(const mjLogMessage_*) = nullptr;
  void (*error_)(const char*) = nullptr;
  void (*warning_)(const char*) = nullptr;
};

}  // namespace trackbed
