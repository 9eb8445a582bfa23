#include "src/bag/decompress.h"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "src/bag/topics.h"
#include "trackbed/core/error.h"

// Decompresses frames of lz4 and zstd in steps, so that the memory used depends on the data in a
// frame, not on the size that its header declares.
namespace trackbed {
namespace {

constexpr std::size_t kStep = std::size_t{1} << 18U;  // output of one decompression step [bytes]

std::string DecompressLz4(std::string_view data, std::size_t largest,
                          const std::filesystem::path& file) {
  LZ4F_dctx* created = nullptr;
  TRACKBED_CHECK(LZ4F_isError(LZ4F_createDecompressionContext(&created, LZ4F_VERSION)) == 0U,
                 "LZ4F_createDecompressionContext");
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(
      created, LZ4F_freeDecompressionContext);
  std::string out;
  std::string step(std::min(kStep, largest + 1), '\0');
  std::size_t left = 1;
  while (left != 0) {
    std::size_t in = data.size();
    std::size_t produced = step.size();
    left = LZ4F_decompress(context.get(), step.data(), &produced, data.data(), &in, nullptr);
    if (LZ4F_isError(left) != 0U || (in == 0 && produced == 0 && left != 0)) {
      RefuseBag(file, fmt::format("a chunk of lz4 is damaged: {}", LZ4F_isError(left) != 0U
                                                                       ? LZ4F_getErrorName(left)
                                                                       : "it ends too early"));
    }
    data.remove_prefix(in);
    out.append(step.data(), produced);
    if (out.size() > largest) {
      RefuseBag(file,
                fmt::format("a chunk of lz4 is larger than the {} bytes that it states", largest));
    }
  }
  return out;
}

std::string DecompressZstd(std::string_view data, std::size_t largest,
                           const std::filesystem::path& file) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  TRACKBED_CHECK(stream != nullptr, "ZSTD_createDStream");
  constexpr int kMaxWindowLog = 27;  // zstd windows of at most 128 MiB
  ZSTD_DCtx_setParameter(stream.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  std::string out;
  std::string step(std::min(kStep, largest + 1), '\0');
  ZSTD_inBuffer in{data.data(), data.size(), 0};
  std::size_t left = 1;
  while (left != 0) {
    ZSTD_outBuffer produced{step.data(), step.size(), 0};
    const std::size_t before = in.pos;
    left = ZSTD_decompressStream(stream.get(), &produced, &in);
    if (ZSTD_isError(left) != 0U || (in.pos == before && produced.pos == 0 && left != 0)) {
      RefuseBag(file, fmt::format("a part compressed by zstd is damaged: {}",
                                  ZSTD_isError(left) != 0U ? ZSTD_getErrorName(left)
                                                           : "it ends too early"));
    }
    out.append(step.data(), produced.pos);
    if (out.size() > largest) {
      RefuseBag(file, fmt::format("a part compressed by zstd is larger than {} bytes", largest));
    }
  }
  return out;
}

}  // namespace

std::string Decompress(std::string_view data, const std::string& compression, std::size_t largest,
                       const std::filesystem::path& file) {
  if (compression.empty()) {
    return std::string(data);
  }
  if (compression == "lz4") {
    return DecompressLz4(data, largest, file);
  }
  if (compression == "zstd") {
    return DecompressZstd(data, largest, file);
  }
  RefuseBag(file, fmt::format("the compression '{}' is unknown; allowed: lz4, zstd",
                              compression.substr(0, 40)));
}

}  // namespace trackbed
