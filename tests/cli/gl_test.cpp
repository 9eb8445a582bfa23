#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace trackbed {
namespace {

class GlOption : public testing::Test {
 protected:
  GlOption() {
    Trackbed(folder_, "run -q " + ScenarioFile("winding") + " -o r --set drive.time_limit=0.1");
  }
  /// Runs `render` for one small picture with these environment settings.
  [[nodiscard]] Outcome Picture(const std::string& environment, const std::string& options) const {
    return Shell(folder_, "env -u MUJOCO_GL " + environment +
                              " " TRACKBED_PROGRAM " render r --size 128x72 --at 0.1 -o p.png " +
                              options);
  }

  TempFolder folder_;
};

TEST_F(GlOption, DrawsWithEgl) {
  const Outcome outcome = Picture("", "--gl egl");
  if (outcome.code == 2 && (outcome.output.find("libEGL.so.1") != std::string::npos ||
                            outcome.output.starts_with("EGL makes no"))) {
    GTEST_SKIP() << outcome.output;
  }
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.output, "p.png\n");
  EXPECT_EQ(Picture("MUJOCO_GL=egl", "").output, "p.png\n");
}

TEST_F(GlOption, NamesThePackagesWhenEglHasNoDriver) {
  const Outcome outcome = Picture("__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere", "--gl egl");
  if (outcome.output.find("libEGL.so.1") != std::string::npos) {
    GTEST_SKIP() << outcome.output;
  }
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output,
              testing::MatchesRegex("EGL makes no OpenGL context without a display \\(error "
                                    "0x[0-9a-f]+\\): install the EGL driver of the graphics card, "
                                    "or Debian's packages libegl-mesa0 and libgl1-mesa-dri\n"));
}

TEST_F(GlOption, RefusesWindows) {
  const Outcome outcome = Picture("MUJOCO_GL=glfw", "");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, testing::StartsWith("MUJOCO_GL: 'glfw'; films are drawn without"));
}

TEST(Gl, IsCheckedBeforeTheRun) {
  const TempFolder folder;
  if (!HasVideo(folder)) {
    GTEST_SKIP() << "built without video";
  }
  const Outcome run = Trackbed(folder, "run " + ScenarioFile("winding") + " --video --gl glfw");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.output, "gl: unknown OpenGL library 'glfw'; allowed: auto, egl, osmesa\n");
  EXPECT_TRUE(folder.Names().empty());
}

}  // namespace
}  // namespace trackbed
