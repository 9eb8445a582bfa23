#include "render/handles.h"

#include "trackbed/core/error.h"

namespace trackbed::render {

MuJoCoErrorsAsExceptions::MuJoCoErrorsAsExceptions()
    : error_(mju_user_error), warning_(mju_user_warning) {
  mju_user_error = [](const char* message) {
    throw RunError(fmt::format("MuJoCo stopped: {}", message));
  };
  mju_user_warning = [](const char*) {};
}

MuJoCoErrorsAsExceptions::~MuJoCoErrorsAsExceptions() {
  mju_user_error = error_;
  mju_user_warning = warning_;
}

}  // namespace trackbed::render
