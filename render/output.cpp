#include "render/output.h"

#include <png.h>

#include <array>
#include <utility>

#include "render/video.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Implements the outputs to which a film is written. The class FrameOutput writes numbered PNG
// files with libpng; render/video/ contains the formats that FFmpeg encodes. The class
// BackgroundOutput passes frames to another output in a separate thread, through a queue of at most
// two frames that a mutex guards. The next call of BackgroundOutput rethrows an exception of the
// writing thread. The function EncodePng adds a PNG chunk that identifies Trackbed as the author.
namespace trackbed::render {
namespace {

namespace fs = std::filesystem;

// total length of a PNG file's signature and IHDR chunk [bytes]
constexpr std::size_t kHeaderSize = 33;

/// Writes one PNG file per frame, into a hidden folder until the film is complete. On completion,
/// the PNG files of an earlier film of the same name are removed, so that frames of two films are
/// never mixed. The PNG files of an earlier film are those that are numbered from 0 without a gap.
/// Throws RunError if a PNG file of an earlier film was not written by Trackbed. If neither
/// Finish() nor Keep() is called, the PNG files of the earlier film stay. Without an earlier film,
/// the new PNG files written so far stay, even if neither Finish() nor Keep() is called.
class FrameOutput : public FilmOutput {
 public:
  explicit FrameOutput(fs::path output) : output_(std::move(output)), frames_(output_) {
    for (int frame = 0; IsThere(frame); ++frame) {
      RequireOwn(FrameName(output_, frame));
    }
  }
  FrameOutput(const FrameOutput&) = delete;
  FrameOutput& operator=(const FrameOutput&) = delete;
  ~FrameOutput() override {
    std::error_code ignored;
    if (!fs::exists(FrameName(output_, 0), ignored)) {
      try {
        FrameOutput::Finish();
      } catch (const RunError&) {
        // The destructor ignores an error of Finish(), because a destructor must not throw.
      }
    }
  }

  void Add(const Image& image) override {
    const fs::path frame = FrameName(output_, next_);
    RequireOwn(frame);  // Add also checks PNG files whose numbers follow a gap
    WriteNewFile(frames_.path() / frame.filename(), EncodePng(image), frame);
    ++next_;
  }
  void Finish() override {
    const int frames = std::exchange(next_, 0);
    std::error_code error;
    int old = 0;
    while (frames > 0 && IsThere(old)) {
      ++old;
    }
    // The PNG files are removed in reverse order of their numbers. If the removal of a file fails,
    // the remaining files are still numbered from 0 without a gap, so the next film can remove
    // them.
    while (old > 0) {
      const fs::path name = FrameName(output_, --old);
      if (!fs::remove(name, error)) {
        throw RunError(fmt::format("cannot remove {}, a frame of an older film: {}", name.string(),
                                   error.message()));
      }
    }
    for (int frame = 0; frame < frames; ++frame) {
      const fs::path name = FrameName(output_, frame);
      fs::rename(frames_.path() / name.filename(), name, error);
      if (error) {
        throw RunError(fmt::format("cannot write {}: {}", name.string(), error.message()));
      }
    }
  }
  void Keep() override { Finish(); }

 private:
  static bool IsFile(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(fs::symlink_status(file, ignored));
  }
  [[nodiscard]] bool IsThere(int frame) const { return IsFile(FrameName(output_, frame)); }
  /// Throws RunError if something that Trackbed did not write, such as a link, has the frame's
  /// name.
  static void RequireOwn(const fs::path& frame) {
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(frame, ignored)) && !(IsFile(frame) && HasMark(frame))) {
      throw RunError(fmt::format(
          "{} has the name of a frame of the film, but is not a frame that Trackbed wrote; choose "
          "another name (-o)",
          frame.string()));
    }
  }

  fs::path output_;
  TemporaryFolder frames_;
  int next_ = 0;
};

/// Returns the registry of the film formats.
const std::array<FilmFormat, 4>& FormatTable() {
  static const std::array<FilmFormat, 4> table{{
      {".mp4", "video", true, VideoOpener()},
      {".webp", "animation", false, WebpOpener()},
      {".apng", "animation", false, ApngOpener()},
      {".png", "frames", false,
       [](const fs::path& output, const FilmPictures& /*pictures*/) -> std::unique_ptr<FilmOutput> {
         return std::make_unique<FrameOutput>(output);
       }},
  }};
  return table;
}

}  // namespace

BackgroundOutput::BackgroundOutput(std::unique_ptr<FilmOutput> output)
    : output_(std::move(output)), thread_([this](const std::stop_token& stop) { Write(stop); }) {}

void BackgroundOutput::Add(const Image& image) {
  constexpr std::size_t kMaxWaiting = 2;
  Image copy;
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return failure_ || waiting_.size() < kMaxWaiting; });
    Rethrow();
    if (!free_images_.empty()) {
      copy = std::move(free_images_.back());
      free_images_.pop_back();
    }
  }
  copy = image;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(copy));
  }
  changed_.notify_all();
}

void BackgroundOutput::Finish() {
  std::unique_lock lock(mutex_);
  Await(lock);
  output_->Finish();
}

void BackgroundOutput::Keep() {
  std::unique_lock lock(mutex_);
  Await(lock);
  output_->Keep();
}

void BackgroundOutput::Await(std::unique_lock<std::mutex>& lock) {
  changed_.wait(lock, [this] { return failure_ || (waiting_.empty() && !writing_); });
  Rethrow();
}

void BackgroundOutput::Rethrow() {
  if (failure_) {
    std::rethrow_exception(failure_);
  }
}

void BackgroundOutput::Write(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  // After a stop request, the writing thread still writes all frames in the queue.
  while (changed_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
    Image image = std::move(waiting_.front());
    waiting_.pop_front();
    writing_ = true;
    lock.unlock();
    changed_.notify_all();
    std::exception_ptr failure;
    try {
      output_->Add(image);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    writing_ = false;
    free_images_.push_back(std::move(image));
    failure_ = failure;
    changed_.notify_all();
    if (failure) {
      return;
    }
  }
}

const FilmFormat& FilmFormatFor(const fs::path& output) {
  const std::string extension = output.extension().string();
  std::string found =
      extension.empty() ? "no extension" : fmt::format("unknown extension '{}'", extension);
  std::string known;
  for (const FilmFormat& format : FormatTable()) {
    if (format.open == nullptr) {
      if (format.extension == extension) {
        found =
            fmt::format("this Trackbed was built without {} (TRACKBED_VIDEO=OFF)", format.summary);
      }
      continue;
    }
    if (format.extension == extension) {
      return format;
    }
    known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", format.extension, format.summary);
  }
  throw InputError(Problem{.file = output.string(),
                           .message = fmt::format("{}; a film is made as {}", found, known)});
}

fs::path FrameName(const fs::path& output, int frame) {
  fs::path name = output;
  name.replace_filename(
      fmt::format("{}_{:05}{}", output.stem().string(), frame, output.extension().string()));
  return name;
}

std::string EncodePng(const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  // fast compression: takes a third of the time, for files that are a few percent larger
  png.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    throw RunError(fmt::format("cannot make a PNG: {}", png.message));
  }
  bytes.resize(size);
  bytes.insert(kHeaderSize, PictureMark());
  return bytes;
}

}  // namespace trackbed::render
