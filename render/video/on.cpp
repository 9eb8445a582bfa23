#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <string>
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

/// Size of the chunk IEND, the last chunk of a PNG file.
constexpr std::streamoff kPngEnd = 12;
/// Position in a RIFF file of the size field, which contains the number of bytes after this field.
constexpr std::streamoff kRiffSizeAt = 4;
constexpr std::size_t kRiffSizeBytes = 4;

/// Inserts Trackbed's mark before the end chunk of an APNG file.
void MarkApng(std::fstream& film) {
  std::string end(static_cast<std::size_t>(kPngEnd), '\0');
  film.seekg(-kPngEnd, std::ios::end);
  film.read(end.data(), kPngEnd);
  film.seekp(-kPngEnd, std::ios::end);
  film << PictureMark() << end;
}

/// Appends Trackbed's mark to a WebP file, and adds the size of the mark to the size in the header.
void MarkWebp(std::fstream& film) {
  film.seekp(0, std::ios::end);
  film << WebpMark();
  const auto size = static_cast<std::uint64_t>(film.tellp()) - kRiffSizeAt - kRiffSizeBytes;
  std::string bytes;
  for (std::size_t i = 0; i < kRiffSizeBytes; ++i) {  // little-endian
    bytes.push_back(static_cast<char>((size >> (8 * i)) & 0xFF));
  }
  film.seekp(kRiffSizeAt);
  film << bytes;
}

/// Adds the mark by which HasMark recognizes the film.
void AddMark(std::fstream& film, FilmCodec codec) {
  switch (codec) {
    case FilmCodec::kH264:
      film.seekp(0, std::ios::end);
      film << VideoMark();
      return;
    case FilmCodec::kWebp:
      MarkWebp(film);
      return;
    case FilmCodec::kApng:
      MarkApng(film);
      return;
  }
}

/// Writes a film into a single file, under a temporary name until the film is complete.
class VideoOutput : public FilmOutput {
 public:
  VideoOutput(fs::path output, FilmCodec codec, const FilmPictures& pictures)
      : output_(std::move(output)),
        codec_(codec),
        temporary_(output_),
        writer_(temporary_.path(), output_, codec, pictures) {}

  void Add(const Image& image) override { writer_.Add(image); }
  void Finish() override {
    writer_.Finish();
    std::fstream film(temporary_.path(), std::ios::binary | std::ios::in | std::ios::out);
    AddMark(film, codec_);
    film.flush();
    if (!film) {
      throw RunError(fmt::format("cannot write {}: no room for its last bytes", output_.string()));
    }
    temporary_.Publish();
  }

 private:
  fs::path output_;
  FilmCodec codec_;
  // The temporary file is declared before the writer, so that the file outlives the writer.
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
