#include "render/painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/error_ribbon.h"
#include "render/ground_paint.h"
#include "render/layout.h"
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

/// Copies a picture into another one, as much of it as there is room for.
void Paste(const Image& from, int left, int top, Image& to) {
  const int first_x = std::max(0, -left);
  const int first_y = std::max(0, -top);
  const int width = std::min(from.width, to.width - left) - first_x;
  for (int y = first_y; width > 0 && y < std::min(from.height, to.height - top); ++y) {
    const std::uint8_t* row = from.Pixel(first_x, y);
    std::copy(row, row + 3 * static_cast<std::ptrdiff_t>(width), to.Pixel(left + first_x, top + y));
  }
}

Font ReadFont(Offscreen& offscreen) {
  std::vector<Image> glyphs;
  for (char character = Font::kFirst; character <= Font::kLast; ++character) {
    glyphs.push_back(offscreen.Glyph(character));
  }
  return Font(std::move(glyphs));
}

}  // namespace

std::vector<LegendEntry> LegendOf(const Recording& recording, const Overlays& overlays) {
  std::vector<LegendEntry> legend;
  if (overlays.plan && !recording.plan.empty()) {
    legend.push_back({kPlanColor, "planned path"});
  }
  if (overlays.plan && !recording.new_plans.empty()) {
    legend.push_back({kNewPlanColor, "new plan"});
  }
  const double scale = overlays.error ? recording.scales.error : 0.0;
  const std::string& car = recording.plants.front().plant();
  if (scale > 0.0) {
    legend.push_back({CarColor(0),
                      fmt::format("{}, off path to {:.3g} m", car, scale),
                      {kErrorColors.begin(), kErrorColors.end()}});
  } else {
    legend.push_back({CarColor(0), car});
  }
  for (std::size_t ghost = 1; overlays.ghosts && ghost < recording.plants.size(); ++ghost) {
    legend.push_back({CarColor(ghost), recording.plants[ghost].plant() + " (ghost)"});
  }
  std::vector<double> factors;
  for (const FrictionPatch& patch : recording.world.friction_patches) {
    factors.push_back(patch.friction);
  }
  std::sort(factors.begin(), factors.end());
  factors.erase(std::unique(factors.begin(), factors.end()), factors.end());
  constexpr std::size_t kMostFactors = 3;  // their colors could hardly be told apart
  for (std::size_t i = 0; i < std::min(factors.size(), kMostFactors); ++i) {
    legend.push_back({PatchColorOnRoad(factors[i]), fmt::format("friction x{:.3g}", factors[i])});
  }
  if (overlays.wind && !IsCalm(recording.world.wind)) {
    legend.push_back({kWindColor, "wind"});
  }
  if (overlays.wind &&
      std::any_of(recording.world.wind.gusts.begin(), recording.world.wind.gusts.end(),
                  [](const Gust& gust) { return gust.area.has_value(); })) {
    legend.push_back({kGustColor, "gust"});
  }
  return legend;
}

/// One recording in a part of the picture.
struct Painter::Part {
  Part(Recording& a_recording, int a_left, int a_width, int a_height, const Overlays& overlays,
       const Quality& quality, bool with_inset, const std::string& a_title, Font& font)
      : recording(a_recording),
        left(a_left),
        width(a_width),
        height(a_height),
        subject(a_recording),
        scene(a_recording, overlays, quality.shadows),
        caption{a_title, a_recording.note, LegendOf(a_recording, overlays)} {
    if (with_inset) {
      // Half the pixels would go into a second map of shadows, for a small picture.
      inset = std::make_unique<FilmScene>(a_recording, overlays, false);
    }
    if (overlays.forces) {
      forces.emplace(a_recording);
    }
    if (overlays.strip) {
      strip.emplace(a_recording, width, height, font);
    }
  }

  [[nodiscard]] CameraPose Pose(const Camera& camera, double time) const {
    return camera.pose(subject, time, static_cast<double>(width) / height);
  }

  Recording& recording;
  int left;
  int width;
  int height;
  CameraSubject subject;
  FilmScene scene;
  std::unique_ptr<FilmScene> inset;
  std::optional<TyreForces> forces;
  std::optional<Strip> strip;
  Caption caption;
};

Painter::Painter(std::span<Recording> recordings, const FilmOptions& options)
    : options_(options),
      quality_(FindQuality(options.quality)),
      camera_(FindCamera(options.camera)),
      inset_(options.inset.empty() ? nullptr : &FindCamera(options.inset, "inset")),
      overlays_(OverlaysOf(options.overlays)),
      offscreen_(
          Prepared(*recordings.front().model, quality_,
                   camera_.pose(CameraSubject(recordings.front()), recordings.front().begin(),
                                static_cast<double>(options.width) / options.height)),
          options.width, options.height, quality_.supersampling),
      font_(ReadFont(offscreen_)) {
  ShareScales(recordings);
  const auto count = static_cast<int>(recordings.size());
  for (int i = 0; i < count; ++i) {
    const int left = options.width * i / count;
    const int right = options.width * (i + 1) / count;
    Recording& recording = recordings[static_cast<std::size_t>(i)];
    const std::string title = options.plants.empty()
                                  ? recording.name
                                  : recording.name + ": " + recording.plants.front().plant();
    parts_.push_back(std::make_unique<Part>(recording, left, right - left, options.height,
                                            overlays_, quality_, inset_ != nullptr, title, font_));
  }
}

Painter::~Painter() = default;

void Painter::Paint(double time, Image& image) {
  if (parts_.size() == 1) {
    Paint(*parts_.front(), time, image);
    return;
  }
  image.Resize(options_.width, options_.height);
  for (const std::unique_ptr<Part>& part : parts_) {
    Paint(*part, time, part_image_);
    Paste(part_image_, part->left, 0, image);
  }
  Canvas canvas(image, font_);
  const double seam = Layout(options_.width, options_.height).hairline;
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    canvas.Fill({parts_[i]->left - seam, 0.0, 2.0 * seam, static_cast<double>(image.height)}, 0.0,
                kPanel, 1.0);
  }
}

void Painter::Paint(Part& part, double time, Image& image) {
  const CameraPose pose = part.Pose(camera_, time);
  offscreen_.Render(part.scene.At(time, pose), image, part.width, part.height);
  const Layout layout(part.width, part.height);
  if (part.forces && part.forces->known()) {
    Canvas canvas(image, font_);
    DrawTyreForces(canvas, Projection(pose, part.width, part.height),
                   part.forces->At(time, part.scene.car()), part.forces->metres_per_newton(),
                   layout.hairline);
  }
  double bottom = part.height - layout.margin;
  if (part.strip) {
    part.strip->Draw(image, font_, time);
    bottom = part.strip->top() - 0.5 * layout.pad;
  }
  double top = layout.margin;
  if (overlays_.caption) {
    top = 0.5 * layout.pad + DrawCaption(image, font_, part.caption,
                                         part.recording.ReadingsAt(time), pose.azimuth, bottom);
  }
  if (part.inset) {
    PaintInset(part, time, top, image);
  }
}

void Painter::PaintInset(Part& part, double time, double top, Image& image) {
  constexpr double kShare = 0.3;  // of the picture's sides
  const Layout layout(part.width, part.height);
  const int width = std::max(1, static_cast<int>(kShare * part.width));
  const int height = std::max(1, static_cast<int>(kShare * part.height));
  offscreen_.Render(part.inset->At(time, part.Pose(*inset_, time)), inset_image_, width, height);
  const int frame = static_cast<int>(std::ceil(layout.hairline));
  const int left = static_cast<int>(part.width - layout.margin) - width - frame;
  const int upper = static_cast<int>(top) + frame;
  Canvas(image, font_)
      .Fill({static_cast<double>(left - frame), static_cast<double>(upper - frame),
             static_cast<double>(width + 2 * frame), static_cast<double>(height + 2 * frame)},
            0.0, kValue, 0.9);
  Paste(inset_image_, left, upper, image);
}

mjvScene& Painter::SceneAt(double time) {
  Part& part = *parts_.front();
  return part.scene.At(time, part.Pose(camera_, time));
}

}  // namespace trackbed::render
