#include "render/ground_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "render/mujoco_compat.h"

namespace trackbed::render {
namespace {

constexpr double kSide = 10.0;  // side of the ground square that one copy of the texture covers [m]
constexpr double kLineSpacing = 5.0;
constexpr double kLineWidth = 0.05;
constexpr double kLineLight = 1.12;

/// Returns a pseudorandom number in [-1, 1] that belongs to a corner of a lattice. The pseudorandom
/// number of a corner is the same in every film.
double Scattered(std::uint32_t x, std::uint32_t y, std::uint32_t octave) {
  std::uint32_t h = x * 374761393U + y * 668265263U + octave * 2246822519U;
  h = (h ^ (h >> 13U)) * 1274126177U;
  h ^= h >> 16U;
  return static_cast<double>(h & 0xffffU) / 32767.5 - 1.0;
}

/// Returns periodic value noise in [-1, 1], with `cells` lattice cells along each side of the
/// texture.
double Noise(double u, double v, std::uint32_t cells, std::uint32_t octave) {
  const double x = u * cells;
  const double y = v * cells;
  const auto column = static_cast<std::uint32_t>(x);
  const auto row = static_cast<std::uint32_t>(y);
  const auto smooth = [](double part) { return part * part * (3.0 - 2.0 * part); };
  const double a = smooth(x - column);
  const double b = smooth(y - row);
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return Scattered((column + i) % cells, (row + j) % cells, octave);
  };
  return (1.0 - b) * ((1.0 - a) * at(0, 0) + a * at(1, 0)) +
         b * ((1.0 - a) * at(0, 1) + a * at(1, 1));
}

bool OnLine(double part) {
  const double place = part * kSide;
  return std::abs(place - kLineSpacing * std::round(place / kLineSpacing)) < 0.5 * kLineWidth;
}

}  // namespace

void MakeGroundPlain(mjModel& model, bool lines) {
  const int ground = mj_name2id(&model, mjOBJ_GEOM, "ground");
  const int material = ground < 0 ? -1 : model.geom_matid[ground];
  const int texture = material < 0 ? -1 : mj::ColorTexture(model, material);
  if (texture < 0 || model.tex_type[texture] != mjTEXTURE_2D) {
    return;
  }
  const int width = model.tex_width[texture];
  const int height = model.tex_height[texture];
  const auto [pixels, channels] = mj::Pixels(model, texture);
  std::array<double, 3> mean{};
  for (int i = 0; i < width * height; ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      mean[channel] += pixels[channels * i + static_cast<int>(channel)];
    }
  }
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double u = (column + 0.5) / width;
      const double v = (row + 0.5) / height;
      double light =
          1.0 + 0.03 * Noise(u, v, 7, 0) + 0.025 * Noise(u, v, 29, 1) +
          0.025 * Noise(u, v, 113, 2) +
          0.012 * Scattered(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), 3);
      if (lines && (OnLine(u) || OnLine(v))) {
        light = kLineLight;
      }
      for (std::size_t channel = 0; channel < 3; ++channel) {
        pixels[channels * (row * width + column) + static_cast<int>(channel)] =
            static_cast<mjtByte>(std::clamp(light * mean[channel] / (width * height), 0.0, 255.0));
      }
    }
  }
  for (int i = 0; i < 2; ++i) {
    model.mat_texrepeat[2 * material + i] = static_cast<float>(1.0 / kSide);
  }
}

}  // namespace trackbed::render
