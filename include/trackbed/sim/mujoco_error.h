#pragma once

struct mjLogMessage_;

namespace trackbed {

/// While an instance lives, an error inside MuJoCo throws RunError in the thread that created the
/// instance, and MuJoCo's warnings in that thread are dropped (mjData counts them). Without it,
/// MuJoCo's default handlers write to MUJOCO_LOG.TXT in the current folder and end the process at
/// an error; before 3.10 they first wait for a key on stdin.
///
/// Guarantees: affects no other thread and none of the global handlers (mju_setLogHandler,
/// mju_user_error, mju_user_warning); the destructor restores the thread's previous handlers.
/// Scopes nest; they must end in their thread, in reverse order of their construction. Cost: a few
/// nanoseconds.
class MujocoErrorScope {
 public:
  MujocoErrorScope();
  ~MujocoErrorScope();
  MujocoErrorScope(const MujocoErrorScope&) = delete;
  MujocoErrorScope& operator=(const MujocoErrorScope&) = delete;

 private:
  // The previous handlers: a single one since MuJoCo 3.10, two before.
  void (*log_)(const mjLogMessage_*) = nullptr;
  void (*error_)(const char*) = nullptr;
  void (*warning_)(const char*) = nullptr;
};

}  // namespace trackbed
