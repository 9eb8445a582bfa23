#include "render/painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "render/ground_paint.h"
#include "render/shadow.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed::render {

/// MuJoCo asks its shadow map once per pixel, however many samples a pixel has: multisampling
/// leaves a shadow's edge as stairs. Supersampling smooths it too and costs the same here (0.29 s
/// against 0.31 s for a picture of 1280x720 with shadows).
struct Quality {
  const char* name;
  int supersampling;  // samples per pixel, along each side
  bool shadows;
};

namespace {

constexpr std::array<Quality, 2> kQualities{{{"draft", 1, false}, {"film", 2, true}}};

const Quality& FindQuality(const std::string& name) {
  std::vector<std::string> names;
  for (const Quality& quality : kQualities) {
    if (quality.name == name) {
      return quality;
    }
    names.emplace_back(quality.name);
  }
  throw InputError(
      Problem{.key = "quality", .message = "unknown quality " + UnknownName(name, names)});
}

/// The model, ready for its Offscreen.
mjModel& Prepared(mjModel& model, const Quality& quality, const CameraPose& camera) {
  if (quality.shadows) {
    FitShadowMap(model, camera);
  }
  return model;
}

Font ReadFont(Offscreen& offscreen) {
  std::vector<Image> glyphs;
  for (char character = Font::kFirst; character <= Font::kLast; ++character) {
    glyphs.push_back(offscreen.Glyph(character));
  }
  return Font(std::move(glyphs));
}

}  // namespace

std::vector<LegendEntry> LegendOf(const Recording& recording) {
  std::vector<LegendEntry> legend;
  if (!recording.plan.empty()) {
    legend.push_back({kPlanColor, "planned path"});
  }
  if (!recording.new_plans.empty()) {
    legend.push_back({kNewPlanColor, "new plan"});
  }
  for (std::size_t car = 0; car < recording.plants.size(); ++car) {
    const std::string& plant = recording.plants[car].plant();
    legend.push_back({CarColor(car), car == 0 ? plant : plant + " (ghost)"});
  }
  std::vector<double> factors;
  for (const FrictionPatch& patch : recording.world.friction_patches) {
    factors.push_back(patch.friction);
  }
  std::sort(factors.begin(), factors.end());
  factors.erase(std::unique(factors.begin(), factors.end()), factors.end());
  constexpr std::size_t kMostFactors = 3;  // their colours could hardly be told apart
  for (std::size_t i = 0; i < std::min(factors.size(), kMostFactors); ++i) {
    legend.push_back({PatchColorOnRoad(factors[i]), fmt::format("friction x{:.3g}", factors[i])});
  }
  if (std::any_of(recording.world.wind.gusts.begin(), recording.world.wind.gusts.end(),
                  [](const Gust& gust) { return gust.area.has_value(); })) {
    legend.push_back({kGustColor, "gust"});
  }
  return legend;
}

Painter::Painter(Recording& recording, const FilmOptions& options)
    : recording_(recording),
      quality_(FindQuality(options.quality)),
      camera_(FindCamera(options.camera)),
      subject_(recording),
      aspect_(static_cast<double>(options.width) / options.height),
      offscreen_(
          Prepared(*recording.model, quality_, camera_.pose(subject_, recording.begin(), aspect_)),
          options.width, options.height, quality_.supersampling),
      font_(ReadFont(offscreen_)),
      scene_(recording, quality_.shadows),
      legend_(LegendOf(recording)) {}

void Painter::Paint(double time, Image& image) {
  offscreen_.Render(SceneAt(time), image);
  DrawCaption(image, font_, recording_.name, recording_.note, legend_, recording_.ReadingsAt(time),
              camera_.pose(subject_, time, aspect_).azimuth);
}

mjvScene& Painter::SceneAt(double time) {
  return scene_.At(time, camera_.pose(subject_, time, aspect_));
}

}  // namespace trackbed::render
