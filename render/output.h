#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <utility>

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
};

/// Writes to another output in a thread of its own: while a picture is written, the next one is
/// made. One picture waits, never more. What writing one throws comes out of the next call; on the
/// way out after an exception the picture that is being written is awaited.
class BackgroundOutput : public FilmOutput {
 public:
  explicit BackgroundOutput(std::unique_ptr<FilmOutput> output) : output_(std::move(output)) {}

  void Add(const Image& image) override;
  void Finish() override;

 private:
  void Await();

  std::unique_ptr<FilmOutput> output_;
  Image image_;                // that is being written
  std::future<void> writing_;  // the last one, so that it is awaited before the rest goes
};

/// Opens an output for pictures of a size [px] at frames per second.
using OpenOutput = std::unique_ptr<FilmOutput> (*)(const std::filesystem::path& output, int width,
                                                   int height, double fps);

/// A kind of file that a film can be.
struct FilmFormat {
  std::string extension;  ///< with its dot
  std::string summary;    ///< one word
  bool even_sides;        ///< whether it can only hold pictures of even width and height
  OpenOutput open;        ///< null when this build cannot
};

/// The format that the extension of `output` asks for; InputError naming every one there is when it
/// asks for none of them, or for one that this build cannot make.
const FilmFormat& FormatOf(const std::filesystem::path& output);

/// "frames/f.png" and 7 give "frames/f_00007.png".
std::filesystem::path FrameName(const std::filesystem::path& output, int frame);

/// The picture as a PNG file's bytes. RunError when it cannot be made.
std::string EncodePng(const Image& image);

}  // namespace trackbed::render
