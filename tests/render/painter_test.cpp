#include "render/painter.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "render/layout.h"
#include "tests/render/pictures.h"
#include "trackbed/core/error.h"
#include "trackbed/render/film.h"

namespace trackbed::render {
namespace {

/// Two plants: one drives straight, the other one turns left.
class PainterTest : public FilmSceneTest {
 protected:
  PainterTest() {
    WritePlant(folder_.path(), "kinematic", 2.0, [](double time) {
      return CarPlace{3.0 * time, 1.5 * time, 0.3};
    });
    WriteStraightPlan(folder_.path(), 16.0);
    options_.width = kWidth;
    options_.height = kHeight;
  }

  Image Painted(const FilmOptions& options, double time = 1.0) const {
    std::vector<Recording> recordings;
    for (const std::string& plant : options.plants) {
      recordings.push_back(ReadRecording(folder_.path(), {plant}));
    }
    if (options.plants.empty()) {
      recordings.push_back(ReadRecording(folder_.path()));
    }
    Painter painter(recordings, options);
    Image image;
    painter.Paint(time, image);
    return image;
  }
  template <typename Function>
  static std::string InputMessage(const Function& function) {
    try {
      function();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no InputError";
  }

  FilmOptions options_;
};

/// Number of pixels that differ within a rectangle of two pictures.
int Different(const Image& a, const Image& b, int left, int right, int top, int bottom) {
  int count = 0;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const std::uint8_t* p = a.Pixel(x, y);
      const std::uint8_t* q = b.Pixel(x, y);
      count += p[0] != q[0] || p[1] != q[1] || p[2] != q[2] ? 1 : 0;
    }
  }
  return count;
}

TEST_F(PainterTest, WithoutOverlaysThereIsTheWorldAlone) {
  options_.overlays.clear();
  const Image bare = Painted(options_);
  overlays_.clear();
  EXPECT_TRUE(bare.rgb == Picture("chase", 1.0).rgb);
}

TEST_F(PainterTest, TitleAndNoteAreThoseAskedFor) {
  options_.overlays = {"caption"};
  const Image plain = Painted(options_);
  options_.title = ReadRecording(folder_.path()).name;
  EXPECT_TRUE(Painted(options_).rgb == plain.rgb);
  options_.title = "another";
  EXPECT_GT(Different(Painted(options_), plain, 0, kWidth / 2, 0, kHeight / 4), 20);
  options_.title.clear();
  options_.note = "it fails";
  const Image noted = Painted(options_);
  EXPECT_GT(Different(noted, plain, 0, kWidth / 2, 0, kHeight / 2), 100);
  EXPECT_EQ(Different(noted, plain, kWidth / 2, kWidth, 0, kHeight), 0);
  EXPECT_EQ(Different(noted, plain, 0, kWidth, kHeight / 2, kHeight), 0);
  // A note that does not fit ends with dots and does not overlap the legend.
  options_.note = std::string(200, 'm');
  const Image shortened = Painted(options_);
  EXPECT_GT(Different(shortened, noted, 0, kWidth, 0, kHeight / 2), 100);
  const int end = static_cast<int>(0.7 * kWidth + Layout(kWidth, kHeight).margin) + 1;
  EXPECT_EQ(Different(shortened, plain, end, kWidth, 0, kHeight), 0);
}

TEST_F(PainterTest, PlantsSideBySideAreEachAsAlone) {
  options_.plants = {"kinematic", "mujoco"};
  options_.overlays = {"plan", "trail", "strip", "caption"};
  for (const char* quality : {"draft", "film"}) {
    options_.quality = quality;
    const Image both = Painted(options_);
    ASSERT_EQ(both.width, kWidth);
    for (int part = 0; part < 2; ++part) {
      FilmOptions one = options_;
      one.width = kWidth / 2;
      one.plants = {options_.plants[static_cast<std::size_t>(part)]};
      const Image alone = Painted(one);
      // Both pictures are equal except for the seam, which is at most 1.2 px wide on either side.
      int different = 0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 2; x < kWidth / 2 - 2; ++x) {
          const std::uint8_t* here = both.Pixel(part * kWidth / 2 + x, y);
          different += std::equal(here, here + 3, alone.Pixel(x, y)) ? 0 : 1;
        }
      }
      // MuJoCo fits the shadow map to the camera of the whole picture, and this camera is the same
      // for both widths.
      EXPECT_EQ(different, 0) << quality << ", " << one.plants.front();
    }
  }
}

TEST_F(PainterTest, TheInsetIsTheOtherCamerasPicture) {
  options_.width = 640;
  options_.height = 360;
  options_.overlays = {"plan", "trail"};
  const Image without = Painted(options_);
  options_.inset = "top";
  const Image with = Painted(options_);
  // The inset has 0.3 of the picture's width and height. A margin of 10 px and a frame of 2 px
  // separate it from the right and the upper edge.
  const int left = 640 - 10 - 192 - 2;
  const int top = 10 + 2;
  EXPECT_EQ(Different(with, without, 0, left - 2, 0, 360), 0);
  EXPECT_EQ(Different(with, without, 0, 640, top + 108 + 2, 360), 0);
  FilmOptions other = options_;
  other.width = 192;
  other.height = 108;
  other.camera = "top";
  other.inset.clear();
  const Image alone = Painted(other);
  int different = 0;
  for (int y = 0; y < 108; ++y) {
    for (int x = 0; x < 192; ++x) {
      const std::uint8_t* here = with.Pixel(left + x, top + y);
      different += std::equal(here, here + 3, alone.Pixel(x, y)) ? 0 : 1;
    }
  }
  EXPECT_EQ(different, 0);
}

TEST_F(PainterTest, TheInsetLeavesTheCaptionFree) {
  WriteFileAtomically(folder_.path() / "scenario.resolved.yaml", R"(schema: 1
name: run
mission: {speed: 3, waypoints: [[0, 0], [20, 0]]}
world:
  friction_patches:
    - {x: 50, y: 50, length: 6, width: 2, friction: 0.5}
    - {x: 50, y: 60, length: 6, width: 2, friction: 0.3}
    - {x: 50, y: 70, length: 6, width: 2, friction: 0.1}
  wind: {y: 9, gusts: [{y: 3, shape: step, area: {x: 50, y: 50, length: 8, width: 4}}]}
)");
  options_.width = 640;
  options_.height = 360;
  const Image without = Painted(options_);
  options_.inset = "top";
  const Image with = Painted(options_);
  // The legend begins at 10 px and has ten lines of 16 px and 9.6 px of padding. The lines are the
  // car, the path, the error scale, the ghost with a note, wind, gust and three factors. The
  // readings have one line of 16 px and 6.4 px of padding.
  const int legend_end = 10 + 10 * 16 + 9;
  const int readings_begin = 350 - 16 - 7;
  EXPECT_EQ(Different(with, without, 0, 640, 0, legend_end), 0);
  EXPECT_EQ(Different(with, without, 0, 640, readings_begin, 360), 0);
  EXPECT_GT(Different(with, without, 0, 640, legend_end, readings_begin), 54 * 96 / 2);
}

TEST_F(PainterTest, NamesWhatThereIsNot) {
  options_.inset = "tip";
  EXPECT_EQ(InputMessage([this] { Painted(options_); }),
            "inset: unknown inset 'tip'; did you mean 'top'?");
  EXPECT_EQ(InputMessage([this] { ReadRecording(folder_.path(), {"mojoco"}); }),
            folder_.path().string() + ": plants: unknown plant 'mojoco'; did you mean 'mujoco'?");
}

}  // namespace
}  // namespace trackbed::render
