#pragma once

namespace trackbed {

/// While one lives, an error inside MuJoCo throws RunError in the thread that made it, and MuJoCo's
/// warnings there are dropped (mjData counts them). Without it, MuJoCo's own handlers wait for a
/// key on stdin and write warnings to MUJOCO_LOG.TXT in the current folder.
///
/// Guarantees: affects no other thread and not mju_user_error and mju_user_warning, which are
/// global; afterwards the thread has the handlers it had before. Scopes nest, and end in the thread
/// and in the reverse order in which they began. Cost: a few nanoseconds.
class MujocoErrorScope {
 public:
  MujocoErrorScope();
  ~MujocoErrorScope();
  MujocoErrorScope(const MujocoErrorScope&) = delete;
  MujocoErrorScope& operator=(const MujocoErrorScope&) = delete;

 private:
  void (*error_)(const char*);
  void (*warning_)(const char*);
};

}  // namespace trackbed
