#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"

namespace trackbed::render {

/// A two-dimensional view for an inset, as an alternative to a second camera.
struct FlatView {
  std::string_view name;
  std::string_view summary;
  /// Draws the view of the recording at `time` [s] into the picture.
  void (*draw)(const Recording& recording, Image& image, Font& font, double time);
};

/// The registry of flat views.
const std::vector<FlatView>& FlatViewTable();

/// Content of an inset: a camera or a flat view.
struct Inset {
  const Camera* camera = nullptr;
  const FlatView* view = nullptr;
};

/// Finds a camera or a flat view by name. Throws InputError under `inset`, with the nearest name,
/// if no camera or view has this name.
Inset FindInset(const std::string& name);

}  // namespace trackbed::render
