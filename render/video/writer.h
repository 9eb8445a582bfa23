#pragma once

#include <filesystem>
#include <memory>

#include "render/image.h"
#include "render/output.h"

namespace trackbed::render {

/// Codec and container of a film.
enum class FilmCodec {
  kH264,  ///< MP4: libx264, veryfast (quick: ultrafast), crf 23, yuv420p, BT.709, the index in
          ///< front
  kWebp,  ///< animated WebP: libwebp_anim, quality 80, played for ever
  kApng,  ///< animated PNG: without loss, played for ever
};

/// Writes pictures into a film. One encoder thread and no dates or versions inside, so equal
/// pictures give equal bytes.
///
/// The file is complete only after Finish; without it, the destructor leaves a partial file. About
/// 25 ms per picture at 1280x720 on a busy machine, 8 ms if quick. RunError, naming `shown_name`,
/// if encoding or writing fails.
class VideoWriter {
 public:
  /// For H.264, width and height must be even. `shown_name` is the file's name in messages, since
  /// the file itself may be temporary.
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
