#pragma once

namespace trackbed {

/// Makes MuJoCo's fatal errors throw RunError instead of waiting on stdin, and keeps its warnings
/// off the terminal (they stay counted in mjData). Idempotent; call before anything else of MuJoCo.
void InstallMujocoErrorHandlers();

}  // namespace trackbed
