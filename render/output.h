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

/// Destination to which a film's pictures are written.
class FilmOutput {
 public:
  FilmOutput() = default;
  virtual ~FilmOutput() = default;
  FilmOutput(const FilmOutput&) = delete;
  FilmOutput& operator=(const FilmOutput&) = delete;

  virtual void Add(const Image& image) = 0;
  /// Completes the file. Finish() must be called after the last picture.
  virtual void Finish() = 0;
  /// Called instead of Finish() after an error. Keep() keeps the pictures written so far if each
  /// picture is a separate file.
  virtual void Keep() {}
};

/// Writes pictures to another output in a separate thread, while the next picture is drawn. At most
/// two pictures wait in the queue; with a full queue, Add() blocks. An exception in the writing
/// thread is rethrown by the next call, and no more pictures are written. If another exception
/// destroys this object, the pictures in the queue are still written.
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
  std::mutex mutex_;  // guards the members below, except for the thread
  std::condition_variable_any changed_;
  std::deque<Image> waiting_;
  std::vector<Image> free_images_;  // pictures that have been written and whose memory is reused
  bool writing_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // declared last, so that it is joined before the other members are
                         // destroyed
};

/// Properties shared by all pictures of a film.
struct FilmPictures {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fps = 0.0;
  bool quick = false;  ///< whether to encode a video three times as fast, at the cost of a larger
                       ///< file
};

using OpenOutput = std::unique_ptr<FilmOutput> (*)(const std::filesystem::path& output,
                                                   const FilmPictures& pictures);

/// A file format of films.
struct FilmFormat {
  std::string extension;  ///< File name extension, including the dot.
  std::string summary;    ///< One-word description of the format.
  bool even_sides;        ///< Whether width and height must be even.
  OpenOutput open;        ///< Function that opens an output; null if this build does not support
                          ///< the format.
};

/// Returns the film format that belongs to the file name extension of `output`. If this build does
/// not support the extension, throws InputError that lists all supported formats.
const FilmFormat& FilmFormatFor(const std::filesystem::path& output);

/// Returns the file name of a frame: for "frames/f.png" and frame 7, "frames/f_00007.png".
std::filesystem::path FrameName(const std::filesystem::path& output, int frame);

/// Encodes a picture as a PNG file. Throws RunError if the picture cannot be encoded.
std::string EncodePng(const Image& image);

}  // namespace trackbed::render
