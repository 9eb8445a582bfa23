#include "render/painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/ground_texture.h"
#include "render/layout.h"
#include "render/overlays.h"
#include "render/shadow.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed::render {

/// MuJoCo evaluates its shadow map only once per pixel, so multisampling leaves the edges of
/// shadows jagged. Supersampling smooths the edges of shadows at about the same cost: a frame of
/// 1280x720 with shadows takes 0.29 s, instead of 0.31 s with multisampling.
namespace {

constexpr std::array<Quality, 2> kQualities{{{"draft", 1, false, true}, {"film", 2, true, false}}};

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

/// Prepares the model of the first recording for drawing with Offscreen.
mjModel& Prepared(std::span<Recording> recordings, const Quality& quality,
                  const CameraPose& camera) {
  for (Recording& recording : recordings) {
    MakeGroundPlain(*recording.model, !recording.has_road());
  }
  mjModel& model = *recordings.front().model;
  if (quality.shadows) {
    FitShadowMap(model, camera);
  }
  return model;
}

/// Copies an image into the image `to`, and clips the parts that do not fit.
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

/// A part of the frame that shows one recording.
struct Painter::Part {
  Part(const OverlaySetup& setup, Recording& a_recording, int a_left, const Quality& quality,
       bool with_inset)
      : recording(a_recording),
        left(a_left),
        width(setup.width),
        height(setup.height),
        subject(a_recording),
        overlays(MakeOverlays(setup)),
        legend(MakeLegend(a_recording, overlays)),
        scene(a_recording, overlays, quality.shadows) {
    if (with_inset) {
      // The inset is drawn without a shadow map, which would take as long as drawing half of the
      // frame's pixels.
      inset = std::make_unique<FilmScene>(a_recording, overlays, false);
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
  OverlayList overlays;
  std::vector<LegendEntry> legend;
  FilmScene scene;
  std::unique_ptr<FilmScene> inset;
};

Painter::Painter(std::span<Recording> recordings, const FilmOptions& options)
    : options_(options),
      quality_(FindQuality(options.quality)),
      camera_(FindCamera(options.camera)),
      inset_(options.inset.empty() ? Inset{} : FindInset(options.inset)),
      offscreen_(
          Prepared(recordings, quality_,
                   camera_.pose(CameraSubject(recordings.front()), recordings.front().begin(),
                                static_cast<double>(options.width) / options.height)),
          options.width, options.height, quality_.supersampling, MakeGlContext(options.gl)),
      font_(ReadFont(offscreen_)) {
  ShareScales(recordings);
  const auto count = static_cast<int>(recordings.size());
  for (int i = 0; i < count; ++i) {
    const int left = options.width * i / count;
    const int right = options.width * (i + 1) / count;
    Recording& recording = recordings[static_cast<std::size_t>(i)];
    const std::string name = options.title.empty() ? recording.name : options.title;
    if (!options.note.empty()) {
      recording.note = options.note;
    }
    const OverlaySetup setup{
        .recording = recording,
        .shown = options_.overlays,
        .title = options.plants.empty() ? name : name + ": " + recording.plants.front().plant(),
        .width = right - left,
        .height = options.height,
        .font = font_};
    parts_.push_back(
        std::make_unique<Part>(setup, recording, left, quality_, inset_.camera != nullptr));
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
  PictureContext context{.image = image,
                         .font = font_,
                         .time = time,
                         .camera = pose,
                         .car = part.scene.car(),
                         .legend = part.legend,
                         .top = layout.margin,
                         .bottom = part.height - layout.margin,
                         .left = layout.margin};
  for (const auto& overlay : part.overlays) {
    overlay->Draw(context);
  }
  if (inset_.camera != nullptr || inset_.view != nullptr) {
    PaintInset(part, context);
  }
}

void Painter::PaintInset(Part& part, const PictureContext& context) {
  // Minimum and maximum size of the inset relative to the frame. Between its minimum and maximum
  // size, the inset is as large as the panels permit.
  constexpr double kMinShare = 0.15;
  constexpr double kMaxShare = 0.3;
  const Layout layout(part.width, part.height);
  const int frame = static_cast<int>(std::ceil(layout.hairline));
  const double share =
      std::clamp((context.bottom - context.top - 2 * frame) / part.height, kMinShare, kMaxShare);
  const int width = std::max(1, static_cast<int>(share * part.width));
  const int height = std::max(1, static_cast<int>(share * part.height));
  if (inset_.view != nullptr) {
    inset_image_.Resize(width, height);
    inset_.view->draw(part.recording, inset_image_, font_, context.time);
  } else {
    offscreen_.Render(part.inset->At(context.time, part.Pose(*inset_.camera, context.time)),
                      inset_image_, width, height);
  }
  const int left = static_cast<int>(part.width - layout.margin) - width - frame;
  const int upper = static_cast<int>(context.top) + frame;
  Canvas(context.image, font_)
      .Fill({static_cast<double>(left - frame), static_cast<double>(upper - frame),
             static_cast<double>(width + 2 * frame), static_cast<double>(height + 2 * frame)},
            0.0, kValue, 0.9);
  Paste(inset_image_, left, upper, context.image);
}

mjvScene& Painter::SceneAt(double time) {
  Part& part = *parts_.front();
  return part.scene.At(time, part.Pose(camera_, time));
}

}  // namespace trackbed::render
