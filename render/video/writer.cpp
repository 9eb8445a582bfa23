#include "render/video/writer.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "render/video/libav.h"
#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

struct FreeFormat {
  void operator()(AVFormatContext* format) const {
    Libav().avio_closep(&format->pb);
    Libav().avformat_free_context(format);
  }
};
struct FreeCodec {
  void operator()(AVCodecContext* codec) const { Libav().avcodec_free_context(&codec); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { Libav().av_frame_free(&frame); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { Libav().av_packet_free(&packet); }
};
struct FreeScaler {
  void operator()(SwsContext* scaler) const { Libav().sws_freeContext(scaler); }
};

std::string Describe(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  Libav().av_strerror(error, text.data(), text.size());
  return text.data();
}

/// Encoder, container and settings of a film format.
struct Recipe {
  const char* encoder;
  const char* container;
  AVPixelFormat pixels;
  bool bt709;  // whether colors are converted to BT.709; otherwise they stay RGB
  std::vector<std::pair<const char*, const char*>> encoder_options;
  // Encoder options for quick encoding, which replace encoder_options.
  std::vector<std::pair<const char*, const char*>> quick_options;
  std::vector<std::pair<const char*, const char*>> container_options;
};

const Recipe& EncoderRecipe(FilmCodec codec) {
  // The encoder option mbtree=0 makes films reproducible. Without mbtree=0, the macroblock tree of
  // x264 reads past the end of the frame's rows unless the width is a multiple of 128. The memory
  // beyond the rows differs between runs (seen with build 164 at widths of 96, 320, 854 and 960
  // px).
  static const Recipe h264{"libx264",
                           "mp4",
                           AV_PIX_FMT_YUV420P,
                           true,
                           {{"preset", "superfast"}, {"crf", "23"}, {"mbtree", "0"}},
                           {{"preset", "ultrafast"}},
                           {{"movflags", "+faststart"}}};
  static const Recipe webp{"libwebp_anim",
                           "webp",
                           AV_PIX_FMT_BGRA,
                           false,
                           {{"quality", "80"}, {"compression_level", "4"}},
                           {},
                           {{"loop", "0"}}};
  static const Recipe apng{"apng", "apng",          AV_PIX_FMT_RGB24, false, {{"pred", "mixed"}},
                           {},     {{"plays", "0"}}};
  return codec == FilmCodec::kH264 ? h264 : codec == FilmCodec::kWebp ? webp : apng;
}

}  // namespace

struct VideoWriter::Encoder {
  const Recipe& recipe;
  std::string name;
  std::unique_ptr<AVFormatContext, FreeFormat> format;
  std::unique_ptr<AVCodecContext, FreeCodec> codec;
  // RGB frame in padded memory, since swscale reads past the end of a frame.
  std::unique_ptr<AVFrame, FreeFrame> picture;
  std::unique_ptr<AVFrame, FreeFrame> frame;  // Frame in the pixel format of the encoder.
  std::unique_ptr<AVPacket, FreePacket> packet;
  std::unique_ptr<SwsContext, FreeScaler> scaler;
  AVStream* stream = nullptr;  // owned by format
  std::int64_t next = 0;

  explicit Encoder(const Recipe& of) : recipe(of) {}

  [[noreturn]] void Fail(const std::string& why) const {
    throw RunError(fmt::format("cannot write {}: {}", name, why));
  }
  /// Returns the result of an FFmpeg function; throws RunError if `result` is an error code.
  int Check(int result) const {
    if (result < 0) {
      Fail(Describe(result));
    }
    return result;
  }
  template <typename T>
  T* Check(T* made) const {
    if (made == nullptr) {
      Fail("out of memory");
    }
    return made;
  }

  void OpenCodec(const FilmPictures& pictures) {
    const AVCodec* found = Libav().avcodec_find_encoder_by_name(recipe.encoder);
    if (found == nullptr) {
      Fail(fmt::format("this libavcodec has no encoder {}", recipe.encoder));
    }
    codec.reset(Check(Libav().avcodec_alloc_context3(found)));
    codec->width = pictures.width;
    codec->height = pictures.height;
    codec->framerate = Libav().av_d2q(pictures.fps, 1001000);
    codec->time_base = av_inv_q(codec->framerate);
    codec->pix_fmt = recipe.pixels;
    if (recipe.bt709) {
      codec->color_range = AVCOL_RANGE_MPEG;
      codec->colorspace = AVCOL_SPC_BT709;
      codec->color_primaries = AVCOL_PRI_BT709;
      codec->color_trc = AVCOL_TRC_BT709;
    }
    codec->thread_count = 1;
    codec->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
    SetOptions(recipe.encoder_options);
    if (pictures.quick) {
      SetOptions(recipe.quick_options);
    }
    Check(Libav().avcodec_open2(codec.get(), found, nullptr));
  }

  void SetOptions(const std::vector<std::pair<const char*, const char*>>& options) const {
    for (const auto& [key, value] : options) {
      // av_opt_set also searches the encoder's private options, since some options belong to one
      // encoder only.
      Check(Libav().av_opt_set(codec.get(), key, value, AV_OPT_SEARCH_CHILDREN));
    }
  }

  void OpenFile(const std::filesystem::path& file) {
    AVFormatContext* made = nullptr;
    // The prefix "file:" keeps FFmpeg from treating a file name with a colon as a URL.
    const std::string url = "file:" + file.string();
    Check(Libav().avformat_alloc_output_context2(&made, nullptr, recipe.container, url.c_str()));
    format.reset(made);
    format->flags |= AVFMT_FLAG_BITEXACT;
    stream = Check(Libav().avformat_new_stream(format.get(), nullptr));
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = codec->framerate;
    Check(Libav().avcodec_parameters_from_context(stream->codecpar, codec.get()));
    Check(Libav().avio_open(&format->pb, url.c_str(), AVIO_FLAG_WRITE));
    AVDictionary* options = nullptr;
    for (const auto& [key, value] : recipe.container_options) {
      Libav().av_dict_set(&options, key, value, 0);
    }
    const int result = Libav().avformat_write_header(format.get(), &options);
    Libav().av_dict_free(&options);
    Check(result);
  }

  [[nodiscard]] std::unique_ptr<AVFrame, FreeFrame> NewFrame(AVPixelFormat pixels) const {
    std::unique_ptr<AVFrame, FreeFrame> made(Check(Libav().av_frame_alloc()));
    made->format = pixels;
    made->width = codec->width;
    made->height = codec->height;
    Check(Libav().av_frame_get_buffer(made.get(), 0));
    return made;
  }

  void OpenConversion() {
    picture = NewFrame(AV_PIX_FMT_RGB24);
    frame = NewFrame(codec->pix_fmt);
    frame->color_range = codec->color_range;
    frame->colorspace = codec->colorspace;
    frame->color_primaries = codec->color_primaries;
    frame->color_trc = codec->color_trc;
    packet.reset(Check(Libav().av_packet_alloc()));
    scaler.reset(Check(Libav().sws_getContext(
        codec->width, codec->height, AV_PIX_FMT_RGB24, codec->width, codec->height, codec->pix_fmt,
        SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr, nullptr)));
    if (recipe.bt709) {
      // Sets BT.709 explicitly, since swscale converts to BT.601 by default, regardless of the
      // film's metadata.
      const int* bt709 = Libav().sws_getCoefficients(SWS_CS_ITU709);
      constexpr int kOne = 1 << 16;
      Check(Libav().sws_setColorspaceDetails(scaler.get(), bt709, 1, bt709, 0, 0, kOne, kOne));
    }
  }

  /// Sends a frame to the encoder and writes the encoder's output. A null frame ends the encoding.
  void Encode(const AVFrame* next_frame) {
    Check(Libav().avcodec_send_frame(codec.get(), next_frame));
    for (;;) {
      const int result = Libav().avcodec_receive_packet(codec.get(), packet.get());
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) {
        return;
      }
      Check(result);
      packet->duration = 1;
      Libav().av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
      packet->stream_index = stream->index;
      Check(Libav().av_interleaved_write_frame(format.get(), packet.get()));
      Check(format->pb->error);
    }
  }
};

VideoWriter::VideoWriter(const std::filesystem::path& file, const std::filesystem::path& shown_name,
                         FilmCodec codec, const FilmPictures& pictures)
    : encoder_(std::make_unique<Encoder>(EncoderRecipe(codec))) {
  // Disables log output of libav and x264 to the terminal; failures are reported by error codes.
  Libav().av_log_set_level(AV_LOG_QUIET);
  encoder_->name = shown_name.string();
  encoder_->OpenCodec(pictures);
  encoder_->OpenFile(file);
  encoder_->OpenConversion();
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::Add(const Image& image) {
  Encoder& encoder = *encoder_;
  TRACKBED_CHECK(image.width == encoder.codec->width && image.height == encoder.codec->height,
                 "a picture of {}x{} in a film of {}x{}", image.width, image.height,
                 encoder.codec->width, encoder.codec->height);
  encoder.Check(Libav().av_frame_make_writable(encoder.frame.get()));
  AVFrame& picture = *encoder.picture;
  Libav().av_image_copy_plane(picture.data[0], picture.linesize[0], image.rgb.data(),
                              3 * image.width, 3 * image.width, image.height);
  encoder.Check(Libav().sws_scale(encoder.scaler.get(), picture.data, picture.linesize, 0,
                                  image.height, encoder.frame->data, encoder.frame->linesize));
  encoder.frame->pts = encoder.next++;
  encoder.Encode(encoder.frame.get());
}

void VideoWriter::Finish() {
  Encoder& encoder = *encoder_;
  encoder.Encode(nullptr);
  encoder.Check(Libav().av_write_trailer(encoder.format.get()));
  // The file system may report a full disk only when the film's file is closed.
  encoder.Check(Libav().avio_closep(&encoder.format->pb));
}

}  // namespace trackbed::render
