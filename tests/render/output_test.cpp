// Tests the outputs of films: choice of the format, writing in a background thread, and frame
// files.

#include "render/output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>

#include "render/caption.h"
#include "render/ground_texture.h"
#include "render/layout.h"
#include "render/offscreen.h"
#include "render/overlays.h"
#include "render/plan_lines.h"
#include "render/scene.h"
#include "render/trail.h"
#include "tests/render/decode_png.h"
#include "tests/render/run_folder.h"
#include "tests/support/folder_content.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/render/film.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed::render {
namespace {

namespace fs = std::filesystem;

std::string InputMessage(const std::function<void()>& function) {
  try {
    function();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST(FrameName, NumbersBeforeTheExtension) {
  EXPECT_EQ(FrameName("frames/f.png", 7), "frames/f_00007.png");
  EXPECT_EQ(FrameName("a.b.png", 123456), "a.b_123456.png");
}

bool HasVideo() {
  return VideoEncoder() != "off";
}

/// The list of formats at the end of every message about formats.
std::string KnownFormats() {
  return HasVideo()
             ? "; a film is made as .mp4 (video), .webp (animation), .apng (animation), .png "
               "(frames)"
             : "; a film is made as .png (frames)";
}

TEST(FilmFormatFor, NamesTheFormatsThereAre) {
  EXPECT_EQ(FilmFormatFor("film.png").extension, ".png");
  EXPECT_EQ(InputMessage([] { FilmFormatFor("out/film.gif"); }),
            "out/film.gif: unknown extension '.gif'" + KnownFormats());
  EXPECT_EQ(InputMessage([] { FilmFormatFor("film"); }), "film: no extension" + KnownFormats());
}

TEST(FilmFormatFor, KnowsVideosOrSaysWhyNot) {
  const std::string message = InputMessage([] { CheckFilmName("out/film.mp4"); });
  EXPECT_EQ(message, HasVideo() ? "no InputError"
                                : "out/film.mp4: this Trackbed was built without video "
                                  "(TRACKBED_VIDEO=OFF); a film is made as .png (frames)");
}

/// Stores the pictures slowly; rejects pictures of width 0.
class SlowOutput : public FilmOutput {
 public:
  explicit SlowOutput(std::vector<int>& written) : written_(written) {}

  void Add(const Image& image) override {
    if (image.width == 0) {
      throw RunError("no room");
    }
    std::this_thread::yield();
    written_.push_back(image.width);
  }
  void Finish() override { written_.push_back(-1); }

 private:
  std::vector<int>& written_;
};

TEST(BackgroundOutput, WritesEveryPictureAsItWasAndInOrder) {
  std::vector<int> written;
  BackgroundOutput output(std::make_unique<SlowOutput>(written));
  Image image;
  for (int width = 1; width <= 50; ++width) {
    image.width = width;
    output.Add(image);
    image.width = 0;  // the next picture reuses this memory
  }
  output.Finish();
  ASSERT_EQ(written.size(), 51U);
  EXPECT_TRUE(std::is_sorted(written.begin(), written.end() - 1));
  EXPECT_EQ(written.back(), -1);
}

TEST(BackgroundOutput, PassesOnWhatWritingThrows) {
  std::vector<int> written;
  const Image refused;
  Image image;
  image.width = 1;
  {
    BackgroundOutput output(std::make_unique<SlowOutput>(written));
    output.Add(refused);
    // The queue holds two pictures, so the third Add after the rejected one reports the error.
    EXPECT_THROW(
        {
          for (int i = 0; i < 3; ++i) {
            output.Add(image);
          }
        },
        RunError);
  }
  {
    BackgroundOutput output(std::make_unique<SlowOutput>(written));
    output.Add(refused);
    EXPECT_THROW(output.Finish(), RunError);
  }
  {
    BackgroundOutput output(std::make_unique<SlowOutput>(written));
    output.Add(refused);
    EXPECT_THROW(output.Finish(), RunError);
    EXPECT_THROW(output.Add(image), RunError);  // the error persists
  }
  EXPECT_THAT(written, testing::IsEmpty());
}

/// Blocks in Add until released; records that Add has begun and the number of pictures.
class HeldOutput : public FilmOutput {
 public:
  explicit HeldOutput(std::atomic<bool>& let_go, std::atomic<int>& given)
      : let_go_(let_go), given_(given) {}

  void Add(const Image& /*image*/) override {
    ++given_;
    given_.notify_all();
    let_go_.wait(false);
  }
  void Finish() override {}

 private:
  std::atomic<bool>& let_go_;
  std::atomic<int>& given_;
};

TEST(BackgroundOutput, GoesOnWhileAPictureIsWrittenAndWritesWhatWaits) {
  std::atomic<bool> let_go = false;
  std::atomic<int> given = 0;
  std::thread later;
  {
    BackgroundOutput output(std::make_unique<HeldOutput>(let_go, given));
    Image image;
    output.Add(image);
    given.wait(0);
    // The first picture is still being written, yet these calls return.
    output.Add(image);
    output.Add(image);
    EXPECT_EQ(given, 1);
    // The output is destroyed without Finish, as after an exception.
    later = std::thread([&] {
      let_go = true;
      let_go.notify_all();
    });
  }
  EXPECT_EQ(given, 3);
  later.join();
}

class Frames : public testing::Test {
 protected:
  Frames() : run_(folder_.path() / "run"), output_(folder_.path() / "frames" / "f.png") {
    fs::create_directories(run_);
    CopyPrius(run_);
    WritePlant(run_, "mujoco", 1.0, [](double time) { return CarPlace{3.0 * time, 0.0, 0.0}; });
    WriteStraightPlan(run_, 20.0);
    options_.width = 161;  // pictures may have odd sizes, videos may not
    options_.height = 91;
    options_.fps = 2.0;
  }

  TempFolder folder_;
  fs::path run_;
  fs::path output_;
  FilmOptions options_;
};

TEST_F(Frames, AreOneCompletePictureEach) {
  EXPECT_EQ(RenderFilm(run_, output_, options_).frames, 3);
  EXPECT_THAT(NamesOfEntries(output_.parent_path()),
              testing::UnorderedElementsAre("f_00000.png", "f_00001.png", "f_00002.png"));
  const Image image = DecodePng(ReadFile(FrameName(output_, 2)));
  EXPECT_EQ(image.width, 161);
  EXPECT_EQ(image.height, 91);
}

TEST_F(Frames, AreThePicturesThatAVideoIsMadeOf) {
  options_.width = 160;
  options_.height = 90;
  options_.fps = 1.0;
  options_.overlays = {"plan", "trail", "caption"};
  RenderFilm(run_, output_, options_);
  const MujocoErrorScope errors;
  Recording recording = ReadRecording(run_);
  MakeGroundPlain(*recording.model, !recording.road);
  Offscreen offscreen(*recording.model, 160, 90, 1);
  std::vector<Image> glyphs;
  for (char character = Font::kFirst; character <= Font::kLast; ++character) {
    glyphs.push_back(offscreen.Glyph(character));
  }
  Font font(std::move(glyphs));
  const std::vector<std::string> shown{"plan", "trail"};
  const OverlayList overlays = MakeOverlays({.recording = recording,
                                             .shown = shown,
                                             .title = "run",
                                             .width = 160,
                                             .height = 90,
                                             .font = font});
  FilmScene scene(recording, overlays, false);
  const CameraSubject subject(recording);
  Image image;
  offscreen.Render(scene.At(1.0, FindCamera("chase").pose(subject, 1.0, 160.0 / 90.0)), image);
  DrawCaption(image, font,
              {.title = "run", .legend = {{CarColor(0), "mujoco"}, {kPlanColor, "planned path"}}},
              recording.ReadingsAt(1.0), 0.0, 90.0 - Layout(160, 90).margin);
  EXPECT_TRUE(DecodePng(ReadFile(FrameName(output_, 1))).rgb == image.rgb);
}

TEST_F(Frames, WrittenBeforeAnInterruptionStay) {
  EXPECT_THROW(RenderFilm(run_, output_, options_,
                          [](double fraction) {
                            if (fraction > 0.5) {
                              throw std::runtime_error("interrupted");
                            }
                          }),
               std::runtime_error);
  EXPECT_THAT(NamesOfEntries(output_.parent_path()),
              testing::UnorderedElementsAre("f_00000.png", "f_00001.png"));
}

TEST_F(Frames, OfAnOlderAndLongerFilmGoAndNothingElse) {
  options_.fps = 4.0;
  ASSERT_EQ(RenderFilm(run_, output_, options_).frames, 5);
  // Names that do not match the film's pattern, do not continue its numbering, or are not files.
  const fs::path folder = output_.parent_path();
  const std::vector<std::string> others{"f_00006.png", "f_000003.png",    "f_3.png", "f_00003.jpg",
                                        "g_00003.png", "f_00003.png.bak", "f.png"};
  for (const std::string& other : others) {
    WriteFileAtomically(folder / other, "not ours");
  }
  options_.fps = 2.0;
  ASSERT_EQ(RenderFilm(run_, output_, options_).frames, 3);
  std::vector<std::string> expected{"f_00000.png", "f_00001.png", "f_00002.png"};
  expected.insert(expected.end(), others.begin(), others.end());
  EXPECT_THAT(NamesOfEntries(folder), testing::UnorderedElementsAreArray(expected));
  for (const std::string& other : others) {
    EXPECT_EQ(ReadFile(folder / other), "not ours") << other;
  }
}

TEST_F(Frames, OfAnOlderFilmStayWhereTheyAreNoFiles) {
  const fs::path folder = output_.parent_path();
  fs::create_directories(FrameName(output_, 3));
  RenderFilm(run_, output_, options_);
  EXPECT_TRUE(fs::is_directory(FrameName(output_, 3)));
  fs::remove(FrameName(output_, 3));
  WriteFileAtomically(folder / "picture.png", "kept");
  fs::create_symlink("picture.png", FrameName(output_, 3));
  RenderFilm(run_, output_, options_);
  EXPECT_EQ(ReadFile(FrameName(output_, 3)), "kept");
}

TEST_F(Frames, DoNotReplacePicturesOfOthers) {
  ASSERT_EQ(RenderFilm(run_, output_, options_).frames, 3);
  const std::string own = ReadFile(FrameName(output_, 1));
  // A picture as another program writes it, without the chunk that names Trackbed.
  const std::size_t chunk = own.find("tEXt") - 4;
  const std::string other =
      own.substr(0, chunk) + own.substr(own.find("Trackbed") + 8 + sizeof(std::uint32_t));
  WriteFileAtomically(FrameName(output_, 1), other);
  ASSERT_TRUE(DecodePng(other).rgb == DecodePng(own).rgb);
  try {
    RenderFilm(run_, output_, options_);
    FAIL();
  } catch (const RunError& error) {
    EXPECT_EQ(std::string(error.what()),
              FrameName(output_, 1).string() +
                  " has the name of a frame of the film, but is not a frame that Trackbed wrote; "
                  "choose another name (-o)");
  }
  EXPECT_EQ(ReadFile(FrameName(output_, 1)), other);
}

TEST_F(Frames, DoNotReplaceLinks) {
  const fs::path target = folder_.Write("mine", "mine");
  fs::create_directories(output_.parent_path());
  for (const fs::path& link_target : {target, folder_.path() / "absent"}) {
    fs::create_symlink(link_target, FrameName(output_, 1));
    EXPECT_THROW(RenderFilm(run_, output_, options_), RunError);
    EXPECT_TRUE(fs::is_symlink(FrameName(output_, 1)));
    EXPECT_EQ(ReadFile(target), "mine");
    fs::remove(FrameName(output_, 1));
  }
  EXPECT_FALSE(fs::exists(folder_.path() / "absent"));
}

TEST_F(Frames, AreNotMadeForAnUnknownExtensionOrQuality) {
  output_ = folder_.path() / "frames" / "f.jpg";
  EXPECT_EQ(InputMessage([this] { RenderFilm(run_, output_, options_); }),
            output_.string() + ": unknown extension '.jpg'" + KnownFormats());
  output_ = folder_.path() / "frames" / "f.png";
  options_.quality = "flim";
  EXPECT_EQ(InputMessage([this] { RenderFilm(run_, output_, options_); }),
            "quality: unknown quality 'flim'; did you mean 'film'?");
  EXPECT_FALSE(fs::exists(output_.parent_path()));
}

TEST_F(Frames, OfEveryQualityDifferButNotInSize) {
  options_.fps = 1.0;
  std::vector<std::string> pictures;
  for (const char* quality : {"draft", "film"}) {
    options_.quality = quality;
    RenderFilm(run_, output_, options_);
    pictures.push_back(ReadFile(FrameName(output_, 0)));
    EXPECT_EQ(DecodePng(pictures.back()).width, 161) << quality;
  }
  EXPECT_FALSE(pictures[0] == pictures[1]);
}

}  // namespace
}  // namespace trackbed::render
