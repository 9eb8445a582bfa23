#include "render/gl_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "tests/render/environment_variable.h"
#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

template <typename Error>
std::string MessageOf(auto&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no such error";
}

TEST(GlChoice, PrefersOsmesaInAFreshProcess) {
  EXPECT_THAT(ChooseGl("auto", {}), ElementsAre(GlLibrary::kOsmesa, GlLibrary::kEgl));
}

TEST(GlChoice, TakesTheNamedLibraryAlone) {
  EXPECT_THAT(ChooseGl("egl", {}), ElementsAre(GlLibrary::kEgl));
  EXPECT_THAT(ChooseGl("osmesa", {}), ElementsAre(GlLibrary::kOsmesa));
}

TEST(GlChoice, FollowsMujocoGl) {
  EXPECT_THAT(ChooseGl("auto", {.mujoco_gl = "egl"}), ElementsAre(GlLibrary::kEgl));
  EXPECT_THAT(ChooseGl("auto", {.mujoco_gl = "OSMesa"}), ElementsAre(GlLibrary::kOsmesa));
}

TEST(GlChoice, PrefersTheOptionToMujocoGl) {
  EXPECT_THAT(ChooseGl("osmesa", {.mujoco_gl = "egl"}), ElementsAre(GlLibrary::kOsmesa));
  EXPECT_THAT(ChooseGl("egl", {.mujoco_gl = "glfw"}), ElementsAre(GlLibrary::kEgl));
}

TEST(GlChoice, RefusesWindowsAndNothingInMujocoGl) {
  for (const char* value : {"glfw", "glx", "disable", "0"}) {
    EXPECT_EQ(MessageOf<InputError>([&] { ChooseGl("auto", {.mujoco_gl = value}); }),
              std::string("MUJOCO_GL: '") + value +
                  "'; films are drawn without a window: set this environment variable to egl or "
                  "osmesa, unset it, or pass --gl egl or --gl osmesa");
  }
}

TEST(GlChoice, RefusesUnknownNames) {
  EXPECT_EQ(MessageOf<InputError>([] { ChooseGl("glfw", {}); }),
            "gl: unknown OpenGL library 'glfw'; allowed: auto, egl, osmesa");
  EXPECT_EQ(MessageOf<InputError>([] { ChooseGl("osmessa", {}); }),
            "gl: unknown OpenGL library 'osmessa'; did you mean 'osmesa'?");
}

TEST(GlChoice, KeepsToTheLibraryOfTheProcess) {
  const GlSurroundings egl{.in_process = GlLibrary::kEgl};
  EXPECT_THAT(ChooseGl("auto", egl), ElementsAre(GlLibrary::kEgl));
  EXPECT_THAT(ChooseGl("egl", egl), ElementsAre(GlLibrary::kEgl));
  EXPECT_EQ(MessageOf<RunError>([&] { ChooseGl("osmesa", egl); }),
            "cannot draw with OSMesa: this program links EGL or has drawn with it, and MuJoCo uses "
            "one library for OpenGL in a process; choose egl or auto, or draw in another "
            "process");
  const GlSurroundings osmesa{.in_process = GlLibrary::kOsmesa};
  EXPECT_THAT(ChooseGl("auto", osmesa), ElementsAre(GlLibrary::kOsmesa));
  EXPECT_THAT(MessageOf<RunError>([&] { ChooseGl("egl", osmesa); }),
              HasSubstr("cannot draw with EGL: this program links OSMesa or has drawn with it"));
  EXPECT_THAT(MessageOf<RunError>(
                  [] { ChooseGl("auto", {.mujoco_gl = "osmesa", .in_process = GlLibrary::kEgl}); }),
              HasSubstr("cannot draw with OSMesa"));
}

TEST(GlSurroundings, HaveTheValueOfMujocoGl) {
  const EnvironmentVariable set("MUJOCO_GL", "osmesa");
  EXPECT_EQ(ReadGlSurroundings().mujoco_gl, "osmesa");
  const EnvironmentVariable unset("MUJOCO_GL", nullptr);
  EXPECT_EQ(ReadGlSurroundings().mujoco_gl, "");
}

TEST(GlSurroundings, NameTheLibraryThatHasDrawn) {
  std::optional<GlLibrary> library;
  {
    const auto context = MakeGlContext("auto");
    library = context->library();
    EXPECT_THAT(context->Version(), testing::ContainsRegex("^[0-9]+[.][0-9]+.*, .+"));
  }
  // The library stays in the process after the context is gone.
  EXPECT_EQ(ReadGlSurroundings().in_process, library);
}

// File names that exist on no system.
const GlFiles kNoFiles{.osmesa = "libNoOsmesa.so.8", .egl = "libNoEgl.so.1"};

TEST(GlContext, NamesTheMissingLibraryAndItsPackage) {
  EXPECT_THAT(
      MessageOf<RunError>([] { MakeGlContext({GlLibrary::kOsmesa}, kNoFiles); }),
      testing::StartsWith("cannot load libNoOsmesa.so.8 (Debian's package libosmesa6, up to "
                          "Debian 13; newer ones draw with egl): libNoOsmesa.so.8: "));
  EXPECT_THAT(MessageOf<RunError>([] { MakeGlContext({GlLibrary::kEgl}, kNoFiles); }),
              testing::StartsWith("cannot load libNoEgl.so.1 (Debian's package libegl1, with "
                                  "libgl1-mesa-dri): libNoEgl.so.1: "));
}

TEST(GlContext, NamesThePackagesOfEachDebianWithoutAnyLibrary) {
  EXPECT_THAT(
      MessageOf<RunError>([] {
        MakeGlContext({GlLibrary::kOsmesa, GlLibrary::kEgl}, kNoFiles);
      }),
      AllOf(testing::StartsWith("cannot draw without OSMesa or EGL; install libosmesa6 (Debian 12 "
                                "and 13), or libegl1 and libgl1-mesa-dri (Debian 12, 13 and "
                                "newer): "),
            HasSubstr("libNoOsmesa.so.8: "), HasSubstr("libNoEgl.so.1: ")));
}

TEST(GlContext, NamesTheFunctionThatALibraryLacks) {
  // libm exports no OpenGL functions.
  const GlFiles mathematics{.osmesa = "libm.so.6", .egl = "libm.so.6"};
  EXPECT_THAT(MessageOf<RunError>([&] { MakeGlContext({GlLibrary::kOsmesa}, mathematics); }),
              HasSubstr("undefined symbol: OSMesaMakeCurrent"));
  EXPECT_THAT(MessageOf<RunError>([&] { MakeGlContext({GlLibrary::kEgl}, mathematics); }),
              HasSubstr("undefined symbol: eglGetProcAddress"));
}

}  // namespace
}  // namespace trackbed::render
