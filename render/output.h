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

/// Destination to which the frames of a film are written.
class FilmOutput {
 public:
  FilmOutput() = default;
  virtual ~FilmOutput() = default;
  FilmOutput(const FilmOutput&) = delete;
  FilmOutput& operator=(const FilmOutput&) = delete;

  virtual void Add(const Image& image) = 0;
  /// Completes the film. Call Finish() after the last frame.
  virtual void Finish() = 0;
  /// Call Keep() instead of Finish() after an error. Keep() preserves the frames written so far if
  /// each frame is a separate file.
  virtual void Keep() {}
};

/// Writes frames to another output in a separate thread, while the next frame is drawn. At most two
/// frames wait in the queue; if the queue is full, Add() blocks. The next call of Add() or Finish()
/// rethrows an exception of the writing thread, and no more frames are written. If an exception in
/// the drawing thread destroys the BackgroundOutput, the frames in the queue are still written.
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
  // the mutex protects all members declared below it, except the thread, against concurrent access
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Image> waiting_;
  std::vector<Image> free_images_;  // memory of frames that have already been written, to be reused
  bool writing_ = false;
  std::exception_ptr failure_;
  // the thread is declared last, so that it is joined before the other members are destroyed
  std::jthread thread_;
};

/// Properties shared by all frames of a film.
struct FilmPictures {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fps = 0.0;
  /// whether the video is encoded three times as fast, at the cost of a larger file
  bool quick = false;
};

using OpenOutput = std::unique_ptr<FilmOutput> (*)(const std::filesystem::path& output,
                                                   const FilmPictures& pictures);

/// A file format in which films can be written.
struct FilmFormat {
  std::string extension;  ///< File name extension of the format, including the dot.
  std::string summary;    ///< One-word description of the film format.
  bool even_sides;        ///< Whether the format requires an even width and height.
  /// Function that opens an output in this format; null if this build does not support the format.
  OpenOutput open;
};

/// Returns the film format for the file name extension of `output`. Throws InputError that lists
/// all supported formats if this build does not support the extension.
const FilmFormat& FilmFormatFor(const std::filesystem::path& output);

/// Returns the file name of a frame, such as "frames/f_00007.png" for "frames/f.png" and frame 7.
std::filesystem::path FrameName(const std::filesystem::path& output, int frame);

/// Encodes an image as a PNG file. Throws RunError if the image cannot be encoded.
std::string EncodePng(const Image& image);

}  // namespace trackbed::render
