#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "render/output.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace trackbed::render {
namespace {

/// Decodes a PNG with a reader other than libpng: libavcodec's own decoder.
Image Decode(std::string bytes) {
  Image image;
  const AVCodec* codec = avcodec_find_decoder(AV_CODEC_ID_PNG);
  AVCodecContext* context = avcodec_alloc_context3(codec);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  const auto size = static_cast<int>(bytes.size());
  bytes.append(AV_INPUT_BUFFER_PADDING_SIZE, '\0');
  packet->data = reinterpret_cast<std::uint8_t*>(bytes.data());
  packet->size = size;
  if (avcodec_open2(context, codec, nullptr) == 0 && avcodec_send_packet(context, packet) == 0 &&
      avcodec_receive_frame(context, frame) == 0 && frame->format == AV_PIX_FMT_RGB24) {
    image.Resize(frame->width, frame->height);
    for (int y = 0; y < image.height; ++y) {
      const std::uint8_t* row = frame->data[0] + y * frame->linesize[0];
      std::copy(row, row + 3 * image.width, image.Pixel(0, y));
    }
  } else {
    ADD_FAILURE() << "libavcodec does not decode the PNG as RGB";
  }
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&context);
  return image;
}

TEST(Png, HoldsEveryPixelAsItWas) {
  Image image;
  image.Resize(37, 5);  // odd, with rows that are not multiples of four bytes
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = static_cast<std::uint8_t>(37 * i * i + 11 * i);
  }
  const Image decoded = Decode(EncodePng(image));
  EXPECT_EQ(decoded.width, 37);
  EXPECT_EQ(decoded.height, 5);
  EXPECT_TRUE(decoded.rgb == image.rgb);
}

}  // namespace
}  // namespace trackbed::render
