#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "render/image.h"

namespace trackbed::render {

/// Where the pictures of a film go.
class FilmOutput {
 public:
  FilmOutput() = default;
  virtual ~FilmOutput() = default;
  FilmOutput(const FilmOutput&) = delete;
  FilmOutput& operator=(const FilmOutput&) = delete;

  virtual void Add(const Image& image) = 0;
  /// Call after the last picture: only then is what was written of worth.
  virtual void Finish() = 0;
  /// Instead of Finish, when no more pictures come: keeps what is of worth alone.
  virtual void Keep() {}
};

/// Writes to another output in a thread of its own: while pictures are written, the next one is
/// made. Two wait at most; Add waits while they do. What writing one throws comes out of the next
/// call, and nothing is written after it; on the way out after another exception those that wait
/// are written first.
class BackgroundOutput : public FilmOutput {
 public:
  explicit BackgroundOutput(std::unique_ptr<FilmOutput> output);

  void Add(const Image& image) override;
  void Finish() override;
  void Keep() override;

 private:
  void Await(std::unique_lock<std::mutex>& lock);
  void Write(const std::stop_token& stop);
  void Rethrow();

  std::unique_ptr<FilmOutput> output_;
  std::mutex mutex_;  // of what follows, but for the thread
  std::condition_variable_any changed_;
  std::deque<Image> waiting_;
  std::vector<Image> spare_;  // pictures written, whose memory the next ones take
  bool writing_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // last: it is asked to stop and awaited before the rest goes
};

/// The pictures that a film consists of.
struct FilmPictures {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fps = 0.0;
  bool quick = false;  ///< a video is encoded in a third of the time, into a larger file
};

using OpenOutput = std::unique_ptr<FilmOutput> (*)(const std::filesystem::path& output,
                                                   const FilmPictures& pictures);

/// A kind of file that a film can be.
struct FilmFormat {
  std::string extension;  ///< with its dot
  std::string summary;    ///< one word
  bool even_sides;        ///< whether it can only hold pictures of even width and height
  OpenOutput open;        ///< null when this build cannot
};

/// The format that the extension of `output` asks for; InputError naming every one there is when it
/// asks for none of them, or for one that this build cannot make.
const FilmFormat& FilmFormatFor(const std::filesystem::path& output);

/// "frames/f.png" and 7 give "frames/f_00007.png".
std::filesystem::path FrameName(const std::filesystem::path& output, int frame);

/// The picture as a PNG file's bytes. RunError when it cannot be made.
std::string EncodePng(const Image& image);

}  // namespace trackbed::render
