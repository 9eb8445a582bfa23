#pragma once

#include <filesystem>
#include <memory>

#include "render/image.h"
#include "render/output.h"

namespace trackbed::render {

/// Codec and container format of a film.
enum class FilmCodec {
  /// The codec H.264 in MP4, encoded by libx264: preset superfast and crf 23 (quick: preset
  /// ultrafast), yuv420p, BT.709, index at the start of the file.
  kH264,
  kWebp,  ///< Animated WebP, encoded by libwebp_anim: quality 80, endless loop.
  kApng,  ///< Animated PNG: lossless, endless loop.
};

/// Encodes frames into a film. The encoder uses one thread and writes no dates or versions, so the
/// same frames always yield the same bytes.
///
/// The film's file is complete only after Finish(); without Finish(), the destructor leaves a
/// partial file. On a busy machine, encoding a frame of 1280x720 takes about 25 ms, or 8 ms with
/// quick encoding. VideoWriter throws RunError naming `shown_name` if encoding or writing fails.
class VideoWriter {
 public:
  /// Opens the file. H.264 requires an even width and height. Error messages name the file
  /// `shown_name`, since `file` may be a temporary name.
  VideoWriter(const std::filesystem::path& file, const std::filesystem::path& shown_name,
              FilmCodec codec, const FilmPictures& pictures);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void Add(const Image& image);
  void Finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace trackbed::render
