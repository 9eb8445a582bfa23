#include <fmt/format.h>

#include <fstream>
#include <utility>

#include "render/video.h"
#include "render/video/libav.h"
#include "render/video/writer.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/render/film.h"

namespace trackbed {
namespace render {
namespace {

namespace fs = std::filesystem;

/// Writes a film into a single file, under a temporary name until the film is complete.
class VideoOutput : public FilmOutput {
 public:
  VideoOutput(fs::path output, FilmCodec codec, const FilmPictures& pictures)
      : output_(std::move(output)),
        has_boxes_(codec == FilmCodec::kH264),
        temporary_(output_),
        writer_(temporary_.path(), output_, codec, pictures) {}

  void Add(const Image& image) override { writer_.Add(image); }
  void Finish() override {
    writer_.Finish();
    if (has_boxes_) {
      AppendMark();
    }
    temporary_.Publish();
  }

 private:
  void AppendMark() const {
    std::ofstream out(temporary_.path(), std::ios::binary | std::ios::app);
    out << VideoMark() << std::flush;
    if (!out) {
      throw RunError(fmt::format("cannot write {}: no room for its last bytes", output_.string()));
    }
  }

  fs::path output_;
  // Whether the film is an MP4 file, at whose end Trackbed adds a box as its mark.
  bool has_boxes_;
  // The file is declared before the writer, so that it outlives the writer.
  TemporaryFile temporary_;
  VideoWriter writer_;
};

template <FilmCodec codec>
std::unique_ptr<FilmOutput> Open(const fs::path& output, const FilmPictures& pictures) {
  return std::make_unique<VideoOutput>(output, codec, pictures);
}

}  // namespace

OpenOutput VideoOpener() {
  return &Open<FilmCodec::kH264>;
}

OpenOutput WebpOpener() {
  return &Open<FilmCodec::kWebp>;
}

OpenOutput ApngOpener() {
  return &Open<FilmCodec::kApng>;
}

}  // namespace render

std::string VideoEncoder() {
  const unsigned version = render::Libav().avcodec_version();
  return fmt::format("H.264 (libavcodec {}.{}.{})", AV_VERSION_MAJOR(version),
                     AV_VERSION_MINOR(version), AV_VERSION_MICRO(version));
}

}  // namespace trackbed
