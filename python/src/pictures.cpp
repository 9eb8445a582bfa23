#include <png.h>

#include <cstdint>
#include <stdexcept>

#include "python/src/bindings.h"
#include "trackbed/core/error.h"
#include "trackbed/render/film.h"
#include "trackbed/report/report.h"

namespace trackbed::python {
namespace {

namespace fs = std::filesystem;

/// An RGB image, row by row, from the top left.
struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> pixels;
};

Image ReadPng(const fs::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, file.c_str()) == 0) {
    throw RunError("cannot read " + file.string() + ": " + png.message);
  }
  png.format = PNG_FORMAT_RGB;
  Image image{png.width, png.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(png))};
  if (png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr) == 0) {
    throw RunError("cannot read " + file.string() + ": " + png.message);
  }
  return image;
}

/// Only one thread of a process may render (RenderFilm).
std::mutex& RenderMutex() {
  static std::mutex mutex;
  return mutex;
}

py::array_t<std::uint8_t> Frame(const fs::path& folder, double time, int width, int height,
                                const std::string& camera, const std::string& quality) {
  Image image;
  {
    const WithoutGil release;
    const std::lock_guard lock(RenderMutex());
    const fs::path file = folder / "frame.png";
    RenderPicture(folder, file, time,
                  {.width = width, .height = height, .camera = camera, .quality = quality});
    image = ReadPng(file);
    fs::remove(file);
  }
  return py::array_t<std::uint8_t>({image.height, image.width, std::size_t{3}},
                                   image.pixels.data());
}

/// Ends a film whose frames are not all drawn.
struct FilmInterrupted {};

void Film(const fs::path& folder, const fs::path& output, int width, int height, double fps,
          const std::string& camera, const std::string& quality) {
  Signals signals;
  try {
    const WithoutGil release;
    const std::lock_guard lock(RenderMutex());
    const FilmOptions options{
        .width = width, .height = height, .fps = fps, .camera = camera, .quality = quality};
    RenderFilm(folder, output, options, [&](double /*fraction*/) {
      if (signals.Raised()) {
        throw FilmInterrupted();
      }
    });
  } catch (const FilmInterrupted&) {
    signals.Rethrow();
  }
}

}  // namespace

void BindPictures(py::module_& module) {
  module.def("frame", &Frame);
  module.def("film", &Film);
  module.def("report_page", [](const fs::path& folder) {
    const WithoutGil release;
    return ReportPageOf({folder}, folder / "report.html", FilmPlace::kAbsent);
  });
}

}  // namespace trackbed::python
