#include "render/offscreen.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

// Minimum side of the rendering buffer [px]; a glyph of the largest font must fit into this buffer.
constexpr int kMinBufferSide = 128;

void CopyFlipped(const std::vector<std::uint8_t>& from, Image& to) {
  const std::size_t row = 3 * static_cast<std::size_t>(to.width);
  for (int y = 0; y < to.height; ++y) {
    const auto* source = from.data() + row * static_cast<std::size_t>(to.height - 1 - y);
    std::copy(source, source + row, to.Pixel(0, y));
  }
}

/// Averages each square of `side` by `side` samples into one pixel, and reverses the order of the
/// rows. The argument `side` must be a power of two.
void AverageFlipped(const std::vector<std::uint8_t>& from, int side, Image& to) {
  const auto step = static_cast<std::size_t>(side);
  const auto width = static_cast<std::size_t>(to.width);
  const std::size_t row = 3 * width * step;
  const auto samples = static_cast<unsigned>(side * side);
  // The sum of samples is divided by a bit shift, since a division would dominate the run time.
  const int shift = std::countr_zero(samples);
  // Sums over `side` rows of samples, for each color of each sample column.
  std::vector<std::uint16_t> columns(row);
  for (int y = 0; y < to.height; ++y) {
    std::fill(columns.begin(), columns.end(), std::uint16_t{0});
    const auto first = static_cast<std::size_t>(to.height - 1 - y) * step;
    for (std::size_t line = first; line < first + step; ++line) {
      const std::uint8_t* sample = from.data() + row * line;
      for (std::size_t x = 0; x < row; ++x) {
        columns[x] = static_cast<std::uint16_t>(columns[x] + sample[x]);
      }
    }
    const std::uint16_t* column = columns.data();
    std::uint8_t* pixel = to.Pixel(0, y);
    for (std::size_t x = 0; x < width; ++x, pixel += 3) {
      // Each sum of samples starts at half the divisor, so that the division rounds to nearest.
      std::array<unsigned, 3> sums{samples / 2, samples / 2, samples / 2};
      for (std::size_t i = 0; i < step; ++i, column += 3) {
        sums[0] += column[0];
        sums[1] += column[1];
        sums[2] += column[2];
      }
      for (std::size_t i = 0; i < 3; ++i) {
        pixel[i] = static_cast<std::uint8_t>(sums[i] >> shift);
      }
    }
  }
}

}  // namespace

Offscreen::Offscreen(mjModel& model, int width, int height, int supersampling,
                     std::unique_ptr<GlContext> gl)
    : width_(width), height_(height), supersampling_(supersampling), gl_(std::move(gl)) {
  TRACKBED_CHECK(supersampling == 1 || supersampling == 2 || supersampling == 4,
                 "{} by {} samples a pixel", supersampling, supersampling);
  model.vis.global.offwidth = std::max(supersampling * width, kMinBufferSide);
  model.vis.global.offheight = std::max(supersampling * height, kMinBufferSide);
  model.vis.quality.offsamples = 0;
  mjr_defaultContext(&context_);
  MakeMujocoContext(model);
  mjr_setBuffer(mjFB_OFFSCREEN, &context_);
  const mjrRect largest = mjr_maxViewport(&context_);
  if (context_.currentBuffer != mjFB_OFFSCREEN || largest.width < supersampling * width ||
      largest.height < supersampling * height) {
    mjr_freeContext(&context_);
    throw RunError(fmt::format("cannot make an off-screen picture of {}x{}", width, height));
  }
}

Offscreen::~Offscreen() {
  mjr_freeContext(&context_);
}

void Offscreen::MakeMujocoContext(const mjModel& model) {
  try {
    mjr_makeContext(&model, &context_, mjFONTSCALE_300);
  } catch (const RunError& error) {
    throw RunError(
        fmt::format("{}, with {} (OpenGL {}); MuJoCo loads OpenGL once in a process: if this "
                    "program also draws "
                    "with MuJoCo elsewhere, such as in a window, film in another process",
                    error.what(), NameOf(gl_->library()), gl_->Version()));
  }
}

void Offscreen::Draw(mjvScene& scene, int width, int height) {
  TRACKBED_CHECK(width <= width_ && height <= height_, "a picture of {}x{} in buffers of {}x{}",
                 width, height, width_, height_);
  const mjrRect viewport{0, 0, supersampling_ * width, supersampling_ * height};
  upside_down_.resize(3 * static_cast<std::size_t>(viewport.width) *
                      static_cast<std::size_t>(viewport.height));
  mjr_render(viewport, &scene, &context_);
  mjr_readPixels(upside_down_.data(), nullptr, viewport, &context_);
}

void Offscreen::Render(mjvScene& scene, Image& image, int width, int height) {
  Draw(scene, width, height);
  image.Resize(width, height);
  if (supersampling_ == 1) {
    CopyFlipped(upside_down_, image);
  } else {
    AverageFlipped(upside_down_, supersampling_, image);
  }
}

Image Offscreen::Glyph(char character) {
  TRACKBED_CHECK(character >= ' ' && character <= '~', "no glyph for character {}",
                 static_cast<int>(character));
  Image image;
  image.Resize(context_.charWidthBig[static_cast<unsigned char>(character)],
               context_.charHeightBig);
  const mjrRect cell{0, 0, image.width, image.height};
  const mjrRect whole{0, 0, kMinBufferSide, kMinBufferSide};
  mjr_rectangle(whole, 0, 0, 0, 1);
  const std::array<char, 2> text{character, '\0'};
  mjr_text(mjFONT_BIG, text.data(), &context_, 0, 0, 1, 1, 1);
  std::vector<std::uint8_t> pixels(image.rgb.size());
  mjr_readPixels(pixels.data(), nullptr, cell, &context_);
  CopyFlipped(pixels, image);
  return image;
}

}  // namespace trackbed::render
