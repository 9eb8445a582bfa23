#include "render/video/libav.h"

#include <fmt/format.h>

#include <type_traits>

#include "render/runtime_library.h"

namespace trackbed::render {
namespace {

RuntimeLibrary Load(const char* name, int version) {
  return {fmt::format("lib{}.so.{}", name, version), fmt::format("lib{}{}", name, version)};
}

LibavFunctions LoadAll() {
  const RuntimeLibrary util = Load("avutil", LIBAVUTIL_VERSION_MAJOR);
  const RuntimeLibrary codec = Load("avcodec", LIBAVCODEC_VERSION_MAJOR);
  const RuntimeLibrary format = Load("avformat", LIBAVFORMAT_VERSION_MAJOR);
  const RuntimeLibrary scale = Load("swscale", LIBSWSCALE_VERSION_MAJOR);
  LibavFunctions av{};
  const auto find = [](const RuntimeLibrary& library, auto& function, const char* name) {
    function =
        library.Find<std::remove_pointer_t<std::remove_reference_t<decltype(function)>>>(name);
  };
  find(codec, av.avcodec_alloc_context3, "avcodec_alloc_context3");
  find(codec, av.avcodec_find_encoder_by_name, "avcodec_find_encoder_by_name");
  find(codec, av.avcodec_free_context, "avcodec_free_context");
  find(codec, av.avcodec_open2, "avcodec_open2");
  find(codec, av.avcodec_parameters_from_context, "avcodec_parameters_from_context");
  find(codec, av.avcodec_receive_packet, "avcodec_receive_packet");
  find(codec, av.avcodec_send_frame, "avcodec_send_frame");
  find(codec, av.avcodec_version, "avcodec_version");
  find(codec, av.av_packet_alloc, "av_packet_alloc");
  find(codec, av.av_packet_free, "av_packet_free");
  find(codec, av.av_packet_rescale_ts, "av_packet_rescale_ts");
  find(format, av.av_interleaved_write_frame, "av_interleaved_write_frame");
  find(format, av.av_write_trailer, "av_write_trailer");
  find(format, av.avformat_alloc_output_context2, "avformat_alloc_output_context2");
  find(format, av.avformat_free_context, "avformat_free_context");
  find(format, av.avformat_new_stream, "avformat_new_stream");
  find(format, av.avformat_write_header, "avformat_write_header");
  find(format, av.avio_closep, "avio_closep");
  find(format, av.avio_open, "avio_open");
  find(util, av.av_d2q, "av_d2q");
  find(util, av.av_dict_free, "av_dict_free");
  find(util, av.av_dict_set, "av_dict_set");
  find(util, av.av_frame_alloc, "av_frame_alloc");
  find(util, av.av_frame_free, "av_frame_free");
  find(util, av.av_frame_get_buffer, "av_frame_get_buffer");
  find(util, av.av_frame_make_writable, "av_frame_make_writable");
  find(util, av.av_image_copy_plane, "av_image_copy_plane");
  find(util, av.av_log_set_level, "av_log_set_level");
  find(util, av.av_opt_set, "av_opt_set");
  find(util, av.av_strerror, "av_strerror");
  find(scale, av.sws_freeContext, "sws_freeContext");
  find(scale, av.sws_getCoefficients, "sws_getCoefficients");
  find(scale, av.sws_getContext, "sws_getContext");
  find(scale, av.sws_scale, "sws_scale");
  find(scale, av.sws_setColorspaceDetails, "sws_setColorspaceDetails");
  return av;
}

}  // namespace

const LibavFunctions& Libav() {
  static const LibavFunctions libav = LoadAll();
  return libav;
}

}  // namespace trackbed::render
