#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"

namespace trackbed::render {

/// A two-dimensional view that an inset can show instead of a second camera.
struct FlatView {
  std::string_view name;
  std::string_view summary;
  /// Draws the flat view of the recording at the simulated time `time` [s] into the image of the
  /// inset.
  void (*draw)(const Recording& recording, Image& image, Font& font, double time);
};

/// Returns the registry of flat views.
const std::vector<FlatView>& FlatViewTable();

/// Content of an inset: either a camera or a flat view.
struct Inset {
  const Camera* camera = nullptr;
  const FlatView* view = nullptr;
};

/// Returns the camera or flat view with the given name. Throws InputError for the option `inset`,
/// suggesting the most similar name, if no camera or view has this name.
Inset FindInset(const std::string& name);

}  // namespace trackbed::render
