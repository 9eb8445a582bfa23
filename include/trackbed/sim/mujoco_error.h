#pragma once

struct mjLogMessage_;

namespace trackbed {

/// Converts errors of MuJoCo to exceptions. While an instance exists, an error inside MuJoCo throws
/// RunError in the thread that created the instance. While an instance exists, MuJoCo's warnings in
/// the same thread are not printed, but are still counted in mjData. Without an instance, MuJoCo's
/// default handlers write to MUJOCO_LOG.TXT in the current folder, and an error ends the process.
/// Before MuJoCo 3.10, the default error handler first waits for a key press on stdin.
///
/// Guarantees: other threads and the global handlers (mju_setLogHandler, mju_user_error,
/// mju_user_warning) are not affected. The destructor restores the handlers that the thread had
/// before. Instances of MujocoErrorScope may be nested, and must be destroyed in the thread that
/// created them, in reverse order. Cost: a few nanoseconds for making and destroying an instance.
class MujocoErrorScope {
 public:
  MujocoErrorScope();
  ~MujocoErrorScope();
  MujocoErrorScope(const MujocoErrorScope&) = delete;
  MujocoErrorScope& operator=(const MujocoErrorScope&) = delete;

 private:
  // The handlers that the thread had before: one handler since MuJoCo 3.10, two handlers in older
  // versions.
  [[maybe_unused]] void (*log_)(const mjLogMessage_*) = nullptr;
  [[maybe_unused]] void (*error_)(const char*) = nullptr;
  [[maybe_unused]] void (*warning_)(const char*) = nullptr;
};

}  // namespace trackbed
