#include "trackbed/sim/scene.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "src/sim/asset_check.h"
#include "src/sim/scene_files.h"
#include "src/sim/scene_xml.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"

// Composes the MJCF text of a car from the car's file:
//   1. Resolve <include> elements, but only for files below the car's folder and
//      SceneOptions::asset_folders.
//   2. Check elements and assets, since the files may be untrusted, and give the assets file names
//      without folders.
//   3. Set the steering rate, the given tyre numbers, MuJoCo's option `autolimits` and the
//   timestep.
//   4. Record the line of each element in the car's file, so that error messages can name the line.
// A scene is trusted if all files of the scene are shipped with Trackbed; the files are recognized
// by their SHA-256.
namespace trackbed {

/// Returns the folder that contains models/ and scenarios/, for programs without a data folder next
/// to the executable (cmake/Data.cmake).
const char* PlaceOfData();

namespace {

namespace fs = std::filesystem;
using scene_files::Fail;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

/// Calls `call` for `element` and all elements below it, in document order.
template <typename Call>
void ForEachElement(const XMLElement& element, const Call& call) {
  call(element);
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    ForEachElement(*child, call);
  }
}

/// Rejects elements for which MuJoCo would need unbounded time or memory, or would overflow a
/// buffer.
void CheckElements(const XMLElement& root, const fs::path& file) {
  ForEachElement(root, [&](const XMLElement& element) {
    if (const std::string why = ElementError(element); !why.empty()) {
      Fail(file, element.GetLineNum(), fmt::format("<{}>: {}", element.Name(), why));
    }
  });
}

/// Finds the first element with the name `name` in the MJCF sections `section`, the children of the
/// root element.
XMLElement* FindNamed(XMLElement& root, const char* section, std::string_view name) {
  for (XMLElement* part = root.FirstChildElement(section); part != nullptr;
       part = part->NextSiblingElement(section)) {
    for (XMLElement* element = part->FirstChildElement(); element != nullptr;
         element = element->NextSiblingElement()) {
      const char* own = element->Attribute("name");
      if (own != nullptr && own == name) {
        return element;
      }
    }
  }
  return nullptr;
}

/// Whether the element's tag is `name` and its only attribute is `attribute` with the value
/// `value`, as in a composed model.
bool HasOnly(const XMLElement* element, std::string_view name, const char* attribute,
             std::string_view value) {
  return element != nullptr && element->Name() == name && element->NoChildren() &&
         element->FirstAttribute() != nullptr && element->FirstAttribute()->Next() == nullptr &&
         element->Attribute(attribute) != nullptr && element->Attribute(attribute) == value;
}

/// Sets the vehicle's maximum steering rate in the MJCF model. For a car, the maximum steering rate
/// is the control range of the steering actuator. A vehicle with differential drive has no steering
/// actuator, so its steering rate is a number under <custom>.
void SetSteeringRate(XMLElement& root, double rate) {
  if (XMLElement* steer = FindNamed(root, "actuator", "steer")) {
    steer->SetAttribute("ctrlrange", Numbers({-rate, rate}).c_str());
  } else if (XMLElement* number = FindNamed(root, "custom", "steering_rate")) {
    number->SetAttribute("data", Numbers({rate}).c_str());
  }
}

}  // namespace

fs::path DataFolder() {
  if (const char* folder = std::getenv("TRACKBED_DATA"); folder != nullptr && *folder != '\0') {
    return folder;
  }
  // An installed program finds its data by a path relative to the executable, so program and data
  // may be moved together.
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path beside = (program.parent_path() / TRACKBED_DATA_FROM_PROGRAM).lexically_normal();
  if (!error && fs::is_directory(beside / "models", error)) {
    return beside;
  }
  return PlaceOfData();
}

std::vector<std::string> ModelNames() {
  std::vector<std::string> names;
  const fs::path models = DataFolder() / "models";
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(models, error)) {
    const std::string name = entry.path().filename().string();
    if (fs::is_regular_file(entry.path() / (name + ".xml"))) {
      names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool IsModelPath(const std::string& model) {
  return model.find('/') != std::string::npos || !fs::path(model).extension().empty();
}

fs::path FindModel(const std::string& model, const fs::path& base) {
  const bool is_name = !IsModelPath(model);
  const fs::path file = is_name ? DataFolder() / "models" / model / (model + ".xml") : base / model;
  if (std::error_code error; is_name && !fs::is_regular_file(file, error)) {
    throw InputError(Problem{.message = "unknown model " + UnknownName(model, ModelNames())});
  }
  try {
    OpenInput(file);
  } catch (const RunError& reason) {
    throw InputError(Problem{.message = reason.what()});
  }
  return file;
}

Scene ComposeScene(const fs::path& car_file, const SceneOptions& options) {
  XMLDocument document;
  bool shipped = true;
  scene_files::Load(car_file, document, shipped);
  XMLElement& root = *document.RootElement();
  if (std::string_view(root.Name()) == "robot") {
    Fail(car_file, root.GetLineNum(),
         fmt::format("root element is <robot>, of URDF; must be <mujoco>. `trackbed model {} "
                     "--adapt -o car.xml` makes a car file of it",
                     car_file.string()));
  }
  if (std::string_view(root.Name()) != "mujoco") {
    Fail(car_file, root.GetLineNum(),
         fmt::format("root element is <{}>; must be <mujoco>", root.Name()));
  }
  const scene_files::Origin origin{car_file, car_file.parent_path(), options.asset_folders,
                                   shipped};
  std::set<fs::path> included{fs::weakly_canonical(car_file)};
  scene_files::ResolveIncludes(root, car_file, origin, included);
  CheckElements(root, car_file);

  Scene scene;
  scene_files::GatherAssets(root, origin, scene);
  scene.trusted = shipped;
  if (options.steering_rate) {
    SetSteeringRate(root, *options.steering_rate);
  }
  if (!options.tyre_numbers.empty()) {
    SetTyreNumbers(root, options.tyre_numbers);
  }
  // Sets the compiler option `autolimits`, which is on by default since MuJoCo 3.0. MuJoCo uses the
  // last <compiler> element that sets an attribute, so the car's file can still override this
  // value.
  if (!HasOnly(root.FirstChildElement(), "compiler", "autolimits", "true")) {
    XMLElement* compiler = document.NewElement("compiler");
    compiler->SetAttribute("autolimits", true);
    root.InsertFirstChild(compiler);
  }
  // The new element is appended, because MuJoCo uses the last <option> element.
  const std::string timestep = fmt::format("{}", options.timestep);
  if (!HasOnly(root.LastChildElement(), "option", "timestep", timestep)) {
    XMLElement* option = document.NewElement("option");
    option->SetAttribute("timestep", timestep.c_str());
    root.InsertEndChild(option);
  }

  scene.xml = Print(document);
  ForEachElement(root, [&](const XMLElement& element) {
    scene.lines.push_back(element.GetLineNum());  // line 0 for an included or added element
  });
  return scene;
}

int LineInCarFile(const Scene& scene, int line) {
  if (scene.lines.empty() || line == 0) {
    return 0;
  }
  XMLDocument document;
  ParseComposed(scene.xml, document);
  std::size_t i = 0;
  int found = 0;
  ForEachElement(*document.RootElement(), [&](const XMLElement& element) {
    if (element.GetLineNum() == line) {
      found = i < scene.lines.size() ? scene.lines[i] : 0;
    }
    ++i;
  });
  return found;
}

void WriteScene(const Scene& scene, const fs::path& file) {
  for (const SceneAsset& asset : scene.assets) {
    const fs::path own = file.parent_path() / asset.name;
    std::error_code ignored;
    const fs::file_status status = fs::symlink_status(own, ignored);
    if (fs::exists(status) && !(fs::is_regular_file(status) && ReadFile(own) == asset.content)) {
      throw RunError(
          fmt::format("cannot write {}: there is another file of that name, which the "
                      "model names; move it away, or save the model elsewhere",
                      own.string()));
    }
    if (!fs::exists(status)) {
      WriteFileAtomically(own, asset.content);
    }
  }
  // the model file is written last, because it refers to the asset files
  WriteFileAtomically(file, scene.xml);
}

}  // namespace trackbed
