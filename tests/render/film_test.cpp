// Tests whole films of artificial runs by decoding them again: size, number of frames, duration,
// container format, reproducibility and errors.

#include "trackbed/render/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include "tests/render/run_folder.h"
#include "tests/support/folder_content.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Properties of a film as a player reads them.
struct Played {
  int frames = 0;
  int width = 0;
  int height = 0;
  double duration = 0;  // [s]
  AVCodecID codec = AV_CODEC_ID_NONE;
  int pixel_format = -1;
  AVColorSpace colors = AVCOL_SPC_UNSPECIFIED;
};

Played Play(const fs::path& file) {
  Played played;
  AVFormatContext* format = nullptr;
  if (avformat_open_input(&format, file.c_str(), nullptr, nullptr) < 0 ||
      avformat_find_stream_info(format, nullptr) < 0) {
    ADD_FAILURE() << "libavformat does not open " << file;
    return played;
  }
  const AVStream* stream = format->streams[0];
  played.codec = stream->codecpar->codec_id;
  played.width = stream->codecpar->width;
  played.height = stream->codecpar->height;
  played.pixel_format = stream->codecpar->format;
  played.colors = stream->codecpar->color_space;
  played.duration = static_cast<double>(stream->duration) * av_q2d(stream->time_base);
  AVPacket* packet = av_packet_alloc();
  while (av_read_frame(format, packet) >= 0) {
    ++played.frames;
    av_packet_unref(packet);
  }
  av_packet_free(&packet);
  avformat_close_input(&format);
  return played;
}

template <typename Error, typename Function>
std::string ErrorMessage(const Function& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("another exception: ") + error.what();
  }
  return "no exception";
}

class Film : public testing::Test {
 protected:
  Film() : run_(folder_.path() / "run"), output_(folder_.path() / "out" / "film.mp4") {
    fs::create_directories(run_);
    fs::create_directories(output_.parent_path());
    CopyPrius(run_);
    WritePlant(run_, "mujoco", 1.0, [](double time) { return CarPlace{3.0 * time, 0.0, 0.0}; });
    WritePlant(run_, "kinematic", 1.0, [](double time) {
      return CarPlace{3.0 * time, 0.2 * time, 0.0};
    });
    WriteStraightPlan(run_, 20.0);
    options_.width = 96;
    options_.height = 64;
    options_.fps = 10.0;
  }

  FilmReport Make() const { return RenderFilm(run_, output_, options_); }
  [[nodiscard]] std::string InputMessage() const {
    return ErrorMessage<InputError>([this] { Make(); });
  }

  TempFolder folder_;
  fs::path run_;
  fs::path output_;
  FilmOptions options_;
};

TEST_F(Film, HasTheSizeFramesAndDurationAskedFor) {
  const FilmReport report = Make();
  // The film has eleven frames, at 0, 0.1, ..., 1.0 s. The last frame is at the end of the
  // recording.
  EXPECT_EQ(report.frames, 11);
  EXPECT_DOUBLE_EQ(report.duration, 1.0);
  EXPECT_EQ(report.car, "mujoco");
  EXPECT_THAT(report.ghosts, testing::ElementsAre("kinematic"));

  const Played played = Play(output_);
  EXPECT_EQ(played.frames, 11);
  EXPECT_EQ(played.width, 96);
  EXPECT_EQ(played.height, 64);
  // Each frame is shown for 0.1 s, exact in MP4's integer time base.
  EXPECT_DOUBLE_EQ(played.duration, 1.1);
  EXPECT_EQ(played.codec, AV_CODEC_ID_H264);
  EXPECT_EQ(played.pixel_format, AV_PIX_FMT_YUV420P);
  EXPECT_EQ(played.colors, AVCOL_SPC_BT709);
}

TEST_F(Film, HasItsIndexInFrontOfThePictures) {
  Make();
  const std::string bytes = ReadFile(output_);
  ASSERT_NE(bytes.find("moov"), std::string::npos);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

/// Counts the chunks of this name in a RIFF file.
int Chunks(const std::string& bytes, const std::string& name) {
  int count = 0;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      size |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + 4 + i])) << (8 * i);
    }
    count += bytes.compare(at, 4, name) == 0 ? 1 : 0;
    at += 8 + size + size % 2;
  }
  return count;
}

TEST_F(Film, IsAnAnimatedPictureWhereThatIsAskedFor) {
  options_.width = 97;  // odd, which only H.264 cannot encode
  output_.replace_extension(".apng");
  ASSERT_EQ(Make().frames, 11);
  const Played apng = Play(output_);
  EXPECT_EQ(apng.frames, 11);
  EXPECT_EQ(apng.width, 97);
  EXPECT_EQ(apng.codec, AV_CODEC_ID_APNG);
  // The chunk acTL contains the number of frames and then the number of repetitions (0 for
  // endless).
  const std::string bytes = ReadFile(output_);
  const std::size_t control = bytes.find("acTL");
  ASSERT_NE(control, std::string::npos);
  EXPECT_EQ(bytes.substr(control + 8, 4), std::string(4, '\0'));

  output_.replace_extension(".webp");
  Make();
  const std::string webp = ReadFile(output_);
  EXPECT_EQ(webp.substr(0, 4), "RIFF");
  EXPECT_EQ(webp.substr(8, 8), "WEBPVP8X");
  EXPECT_EQ(Chunks(webp, "ANIM"), 1);
  // The chunk ANIM contains the background color and the number of repetitions.
  EXPECT_EQ(webp.substr(webp.find("ANIM") + 12, 2), std::string(2, '\0'));
  // WebP merges equal frames; these differ.
  EXPECT_EQ(Chunks(webp, "ANMF"), 11);
  Make();
  EXPECT_TRUE(webp == ReadFile(output_));
}

TEST_F(Film, ShowsPlantsSideBySide) {
  options_.width = 192;
  options_.plants = {"kinematic", "mujoco"};
  const FilmReport report = Make();
  EXPECT_EQ(report.car, "kinematic");
  EXPECT_THAT(report.ghosts, testing::IsEmpty());
  EXPECT_EQ(Play(output_).width, 192);
  options_.plants = {"a", "b", "c", "d", "e"};
  EXPECT_EQ(InputMessage(), "plants: 5 side by side; allowed are 1 to 4");
  options_.plants = {"mujoco", "mujoco"};
  EXPECT_EQ(InputMessage(), "plants: 'mujoco' is listed twice");
}

TEST_F(Film, IsTheSameBytesTwice) {
  // Fills fresh memory with a pattern, so that reading uninitialized memory changes the film.
  // libx264 reads uninitialized memory at some widths.
  mallopt(M_PERTURB, 0x55);
  Make();
  const std::string first = ReadFile(output_);
  mallopt(M_PERTURB, 0xAA);
  Make();
  mallopt(M_PERTURB, 0);
  EXPECT_TRUE(first == ReadFile(output_));
}

TEST_F(Film, EveryCameraMakesAFilmOfItsOwn) {
  options_.fps = 1.0;
  std::vector<std::string> films;
  for (const FilmChoice& camera : Cameras()) {
    options_.camera = camera.name;
    EXPECT_EQ(Make().frames, 2) << camera.name;
    EXPECT_FALSE(camera.summary.empty()) << camera.name;
    films.push_back(ReadFile(output_));
    EXPECT_EQ(std::count(films.begin(), films.end(), films.back()), 1) << camera.name;
  }
  EXPECT_EQ(Cameras().front().name, FilmOptions().camera);
}

TEST_F(Film, NeedsNeitherPlanNorCrossTrackNorASecondPlant) {
  fs::remove(run_ / "plan.csv");
  fs::remove(run_ / "mujoco.csv");
  fs::remove(run_ / "mujoco.state.csv");
  WriteFileAtomically(run_ / "kinematic.csv",
                      "t_s,speed_mps,steering_command_rad,steering_rad\n0,3,0,0\n");
  options_.fps = 1.0;
  const FilmReport report = Make();
  EXPECT_EQ(report.car, "kinematic");
  EXPECT_THAT(report.ghosts, testing::IsEmpty());
}

TEST_F(Film, LastsAsLongAsTheLongestRecording) {
  WritePlant(run_, "kinematic", 1.5, [](double) { return CarPlace{}; });
  options_.fps = 2.0;
  EXPECT_EQ(Make().frames, 4);  // 0, 0.5, 1, 1.5 s
}

TEST_F(Film, IsCutWhereItIsAskedFor) {
  options_.overlays = {"trail"};
  const fs::path whole = folder_.path() / "whole" / "f.png";
  const fs::path part = folder_.path() / "part" / "f.png";
  RenderFilm(run_, whole, options_);
  options_.from = 0.3;
  options_.to = 0.75;
  const FilmReport report = RenderFilm(run_, part, options_);
  EXPECT_EQ(report.frames, 5);  // 0.3, 0.4, ..., 0.7 s
  EXPECT_DOUBLE_EQ(report.duration, 0.4);
  for (int frame = 0; frame < 5; ++frame) {
    EXPECT_TRUE(ReadFile(part.parent_path() / fmt::format("f_{:05}.png", frame)) ==
                ReadFile(whole.parent_path() / fmt::format("f_{:05}.png", frame + 3)))
        << frame;
  }
  options_.from = options_.to = 1.0;
  EXPECT_EQ(Make().frames, 1);
}

TEST_F(Film, IsNotCutOutsideOfTheRun) {
  options_.from = -0.1;
  EXPECT_EQ(InputMessage(), "from: -0.1 s; allowed are 0 to 1");
  options_.from = 0.6;
  options_.to = 0.5;
  EXPECT_EQ(InputMessage(), "to: 0.5 s; allowed are 0.6 to 1");
  options_.from.reset();
  options_.to = std::nan("");
  EXPECT_EQ(InputMessage(), "to: nan s; allowed are 0 to 1");
}

TEST_F(Film, APictureIsWhatAFrameIs) {
  const fs::path frames = folder_.path() / "frames" / "f.png";
  const fs::path picture = folder_.path() / "new" / "one.png";
  options_.width = 97;
  RenderFilm(run_, frames, options_);
  RenderPicture(run_, picture, 0.7, options_);
  EXPECT_TRUE(ReadFile(picture) == ReadFile(frames.parent_path() / "f_00007.png"));
  EXPECT_EQ(ErrorMessage<InputError>([&] { RenderPicture(run_, picture, 1.2, options_); }),
            "time: 1.2 s; allowed are 0 to 1");
  EXPECT_EQ(ErrorMessage<InputError>([&] { RenderPicture(run_, "one.jpg", 0.7, options_); }),
            "one.jpg: a picture is made as .png");
}

TEST_F(Film, ReportsRisingProgressUpToOne) {
  std::vector<double> fractions;
  options_.fps = 2.0;
  RenderFilm(run_, output_, options_, [&](double fraction) { fractions.push_back(fraction); });
  ASSERT_EQ(fractions.size(), 3U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_DOUBLE_EQ(fractions.back(), 1.0);
}

TEST_F(Film, LeavesNothingWhenProgressThrows) {
  WriteFileAtomically(output_, "an older film");
  EXPECT_THROW(
      RenderFilm(run_, output_, options_, [](double) { throw std::runtime_error("interrupted"); }),
      std::runtime_error);
  EXPECT_EQ(ReadFile(output_), "an older film");
  EXPECT_THAT(NamesOfEntries(output_.parent_path()), testing::ElementsAre("film.mp4"));
}

TEST_F(Film, RefusesOptionsOutOfRangeAllAtOnce) {
  options_ = {.width = 641, .height = 10, .fps = 0.0, .camera = "chase"};
  EXPECT_EQ(InputMessage(),
            "width: 641 px; must be even, because the film stores color for 2x2 pixels\n"
            "height: 10 px; allowed are 64 to 4320\n"
            "fps: 0; allowed are 1 to 240");
}

TEST_F(Film, NamesTheNearestCamera) {
  options_.camera = "chaise";
  EXPECT_EQ(InputMessage(), "camera: unknown camera 'chaise'; did you mean 'chase'?");
}

TEST_F(Film, SaysWhatIsWrongWithTheFolder) {
  const std::string run = run_.string();
  const auto message_of = [this](const fs::path& folder) {
    return ErrorMessage<InputError>([&] { RenderFilm(folder, output_, options_); });
  };
  EXPECT_EQ(message_of(folder_.path() / "nowhere"),
            (folder_.path() / "nowhere").string() + ": no such folder");
  EXPECT_EQ(message_of(run_ / "plan.csv"), run + "/plan.csv: not a folder, but a run is one");
  EXPECT_EQ(message_of(output_.parent_path()),
            output_.parent_path().string() +
                ": no <plant>.state.csv in the folder: not a run, or one that recorded nothing");

  WriteFileAtomically(run_ / "plan.csv", "s_m,x_m\n0,0\n");
  EXPECT_EQ(InputMessage(), run + "/plan.csv: y_m: no such column");
  fs::remove(run_ / "mujoco.csv");
  EXPECT_EQ(InputMessage(), run + "/mujoco.csv: missing from the run folder");
  WriteFileAtomically(run_ / "mujoco.state.csv", "t_s,x_m\n0,0\n1,x\n");
  EXPECT_EQ(InputMessage(), run + "/mujoco.state.csv:3: cell 2 (x_m): 'x' is not a number");
  WriteFileAtomically(run_ / "mujoco.state.csv", "t_s,x_m\n0,0\n0,1\n");
  EXPECT_EQ(InputMessage(), run + "/mujoco.state.csv: t_s: row 2: 0 does not come after 0");
  WriteFileAtomically(run_ / "mujoco.state.csv", "t_s,x_m\n0,nan\n");
  EXPECT_EQ(InputMessage(), run + "/mujoco.state.csv: x_m: row 1: not finite");
  WriteFileAtomically(run_ / "mujoco.state.csv", "t_s,x_m\n");
  EXPECT_EQ(InputMessage(), run + "/mujoco.state.csv: no rows");
  fs::remove(run_ / "model.xml");
  EXPECT_EQ(InputMessage(), run + "/model.xml: missing from the run folder");
  EXPECT_THAT(NamesOfEntries(output_.parent_path()), testing::IsEmpty());
}

TEST_F(Film, NamesTheJointThatTheStatesLack) {
  std::string states = ReadFile(run_ / "mujoco.state.csv");
  states.replace(states.find("rack_rad"), 8, "rock_rad");
  WriteFileAtomically(run_ / "mujoco.state.csv", states);
  EXPECT_EQ(InputMessage(), run_.string() + "/mujoco.state.csv: rack_rad: no such column");
}

TEST_F(Film, RefusesABrokenModelWithoutAskingForAKey) {
  WriteFileAtomically(run_ / "model.xml", "<mujoco><worldbody><geom/></worldbody></mujoco>");
  EXPECT_THAT(InputMessage(),
              testing::StartsWith(run_.string() + "/model.xml:1: does not compile: "));
}

TEST_F(Film, LeavesNothingWhereItCannotWrite) {
  WriteFileAtomically(folder_.path() / "file", "no folder");
  output_ = folder_.path() / "file" / "film.mp4";
  EXPECT_THAT(ErrorMessage<RunError>([this] { Make(); }),
              testing::HasSubstr((folder_.path() / "file").string()));
  EXPECT_EQ(ReadFile(folder_.path() / "file"), "no folder");
}

TEST_F(Film, MakesItsFolderButNotForNothing) {
  output_ = folder_.path() / "new" / "deep" / "film.webp";
  options_.fps = 2.0;
  options_.camera = "chaise";
  EXPECT_EQ(InputMessage(), "camera: unknown camera 'chaise'; did you mean 'chase'?");
  EXPECT_FALSE(fs::exists(folder_.path() / "new"));
  options_.camera = "chase";
  Make();
  EXPECT_TRUE(fs::exists(output_));
}

/// Limits the size of files of this process, to simulate a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(Film, LeavesTheOlderFilmWhenTheDiskIsFull) {
  WriteFileAtomically(output_, "an older film");
  std::string message;
  {
    const SmallDisk disk(500);  // less than the index of any film
    message = ErrorMessage<RunError>([this] { Make(); });
  }
  EXPECT_EQ(message, "cannot write " + output_.string() + ": File too large");
  EXPECT_EQ(ReadFile(output_), "an older film");
  EXPECT_THAT(NamesOfEntries(output_.parent_path()), testing::ElementsAre("film.mp4"));
}

}  // namespace
}  // namespace trackbed
