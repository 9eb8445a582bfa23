#pragma once

#include <filesystem>
#include <memory>

#include "render/image.h"
#include "render/output.h"

namespace trackbed::render {

/// Codec and container of a film.
enum class FilmCodec {
  kH264,  ///< MP4: libx264, veryfast (quick: ultrafast), crf 23, yuv420p, BT.709, the index in
          ///< front.
  kWebp,  ///< Animated WebP: libwebp_anim, quality 80, in an endless loop.
  kApng,  ///< Animated PNG: lossless, in an endless loop.
};

/// Writes pictures into a film. The encoder has one thread and writes no dates or versions, so
/// equal pictures give equal bytes.
///
/// The video file is complete only after Finish; without Finish, the destructor leaves a partial
/// file. Encoding takes about 25 ms per picture at 1280x720 on a busy machine, 8 ms if quick.
/// VideoWriter throws RunError naming `shown_name` if encoding or writing fails.
class VideoWriter {
 public:
  /// H.264 requires an even width and height. `shown_name` is the file's name in messages, since
  /// `file` itself may be temporary.
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
