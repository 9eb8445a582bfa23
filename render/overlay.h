#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/recording.h"

/// Interface of overlays, which draw over the recorded world. See docs/how-to/add-an-overlay.md.
namespace trackbed::render {

/// Symbol of a color in the legend.
enum class LegendSymbol {
  kLine,     ///< A line on the ground.
  kOutline,  ///< Outline of an area or a box.
  kDiamond,  ///< A mark on the ground.
  kCross,    ///< A cross on the ground.
  kDial,     ///< A dial of the used friction.
};

/// An entry of the legend: the meaning of a color in the picture.
struct LegendEntry {
  Color color;
  std::string text;
  std::string note{};         ///< Second line; may be empty.
  std::vector<Color> ramp{};  ///< Colors from left to right, instead of a single color.
  LegendSymbol symbol = LegendSymbol::kLine;
};

/// The world posed for one picture; overlays add shapes to it.
struct SceneContext {
  mjvScene& scene;
  double time;               ///< Time of the picture [s].
  const CameraPose& camera;  ///< Camera of the picture.
  mjvCamera& view;           ///< The same camera for MuJoCo.
  const mjvOption& visible;  ///< Which parts of a model are visible.
};

/// A rendered picture on which overlays draw.
struct PictureContext {
  Image& image;
  Font& font;
  double time;  ///< [s]
  const CameraPose& camera;
  const mjData& car;  ///< the car at `time`
  const std::vector<LegendEntry>& legend;
  double top;     ///< Bottom of the panels at the upper edge [px]; each new panel increases it.
  double bottom;  ///< Top of the panels at the lower edge [px]; each new panel decreases it.
  double left;    ///< Start of free space above `bottom` [px]; each new panel increases it.
};

/// Something drawn over the world of one recording. An overlay draws nothing by default.
class Overlay {
 public:
  Overlay() = default;
  virtual ~Overlay() = default;
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// Maximum number of shapes that AddShapes adds.
  [[nodiscard]] virtual std::size_t max_shapes() const { return 0; }
  /// Adds shapes to the world, where the car and other objects hide and shade the shapes. The added
  /// shapes are also shown in an inset.
  virtual void AddShapes(SceneContext& /*context*/) {}
  /// Draws flat over the picture, except over the picture's inset.
  virtual void Draw(PictureContext& /*context*/) {}
  /// Adds entries to the legend, whose first entry is the car.
  virtual void AddLegend(std::vector<LegendEntry>& /*legend*/) const {}
};
using OverlayList = std::vector<std::unique_ptr<Overlay>>;

/// Arguments for making overlays: one recording, in pictures of one size.
struct OverlaySetup {
  const Recording& recording;             ///< The recording must outlive the overlay.
  const std::vector<std::string>& shown;  ///< Names of all overlays of the film.
  std::string title;                      ///< Title of the picture.
  int width = 0;                          ///< Width of the picture [px].
  int height = 0;                         ///< Height of the picture [px].
  Font& font;

  [[nodiscard]] bool Shows(std::string_view name) const {
    return std::find(shown.begin(), shown.end(), name) != shown.end();
  }
};

/// An overlay in the table.
struct OverlayEntry {
  std::string name;
  std::string summary;  ///< summary in one line, shown to users
  std::unique_ptr<Overlay> (*make)(const OverlaySetup& setup);
  bool by_default = true;  ///< whether films show the overlay by default
};

/// The table entry of an overlay whose constructor takes an OverlaySetup.
template <typename Own>
OverlayEntry MakeOverlayEntry(std::string name, std::string summary) {
  return {std::move(name), std::move(summary),
          [](const OverlaySetup& setup) -> std::unique_ptr<Overlay> {
            return std::make_unique<Own>(setup);
          }};
}

}  // namespace trackbed::render
