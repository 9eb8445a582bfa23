#include "trackbed/sim/mujoco_error.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <memory>
#include <string>
#include <thread>

#include "trackbed/core/error.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/scene.h"

namespace trackbed {
namespace {

struct OtherHandler {};

/// An error handler that another library in the same program may have installed for MuJoCo.
void ThrowOther(const char* /*message*/) {
  throw OtherHandler();
}

/// Number of warnings that reached the global handler. The handler must not throw: since MuJoCo
/// 3.10, a thread whose handler throws loses all later messages of MuJoCo.
int warnings = 0;
void CountWarning(const char* /*message*/) {
  ++warnings;
}

/// Restores MuJoCo's global handlers.
class GlobalHandlers {
 public:
  GlobalHandlers() : error_(mju_user_error), warning_(mju_user_warning) {
    mju_user_error = ThrowOther;
    mju_user_warning = CountWarning;
    warnings = 0;
  }
  ~GlobalHandlers() {
    mju_user_error = error_;
    mju_user_warning = warning_;
  }
  GlobalHandlers(const GlobalHandlers&) = delete;
  GlobalHandlers& operator=(const GlobalHandlers&) = delete;

 private:
  void (*error_)(const char*);
  void (*warning_)(const char*);
};

/// The error text for which MuJoCo's own handler would wait for a key press.
std::string MujocoErrorMessage() {
  try {
    mju_error("no such thing");
  } catch (const RunError& error) {
    return error.what();
  } catch (const OtherHandler&) {
    return "the other handler";
  }
  return "nothing";
}

TEST(MujocoErrorScope, ThrowsWhileItLivesAndLeavesTheHandlersAsTheyWere) {
  const GlobalHandlers others;
  EXPECT_EQ(MujocoErrorMessage(), "the other handler");
  {
    const MujocoErrorScope outer;
    EXPECT_EQ(MujocoErrorMessage(), "MuJoCo: no such thing");
    mju_warning("dropped");
    EXPECT_EQ(warnings, 0);
    {
      const MujocoErrorScope inner;
      EXPECT_EQ(MujocoErrorMessage(), "MuJoCo: no such thing");
    }
    EXPECT_EQ(MujocoErrorMessage(), "MuJoCo: no such thing");
  }
  EXPECT_EQ(MujocoErrorMessage(), "the other handler");
  mju_warning("not dropped");
  EXPECT_EQ(warnings, 1);
}

TEST(MujocoErrorScope, EndsWithTheExceptionThatLeavesIt) {
  const GlobalHandlers others;
  try {
    const MujocoErrorScope scope;
    mju_error("no such thing");
    ADD_FAILURE() << "mju_error returned";
  } catch (const RunError&) {
    EXPECT_EQ(MujocoErrorMessage(), "the other handler");
  }
}

TEST(MujocoErrorScope, IsOfItsThreadAlone) {
  const GlobalHandlers others;
  const MujocoErrorScope scope;
  std::string message;
  std::thread([&] { message = MujocoErrorMessage(); }).join();
  EXPECT_EQ(message, "the other handler");
  EXPECT_EQ(MujocoErrorMessage(), "MuJoCo: no such thing");
}

TEST(MujocoErrorScope, IsAroundEveryStepOfThePlantAndNoLonger) {
  const GlobalHandlers others;
  const CarModel car(ComposeScene(FindModel("prius", ""), {}), "prius");
  EXPECT_EQ(MujocoErrorMessage(), "the other handler");
  const World world;
  // A speed above mjMAXVAL (1e10) makes MuJoCo warn; within the scope no handler receives the
  // warning.
  const std::unique_ptr<Plant> plant =
      MakePlant("mujoco", {.car = car, .world = world, .start = {.speed = 1e12}});
  EXPECT_NO_THROW(plant->Step({}));
  EXPECT_TRUE(plant->diverged());
  EXPECT_EQ(warnings, 0);
  EXPECT_EQ(MujocoErrorMessage(), "the other handler");
}

}  // namespace
}  // namespace trackbed
