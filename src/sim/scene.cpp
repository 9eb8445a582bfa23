#include "trackbed/sim/scene.h"

#include <fmt/format.h>
#include <strings.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>

#include "shipped_models.h"
#include "src/sim/asset_check.h"
#include "src/sim/scene_xml.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/file_name.h"
#include "trackbed/core/hash.h"
#include "trackbed/core/spelling.h"

// Composes the MJCF text of a car from the car's file:
//   1. Resolve <include> elements, but only for files below the car's folder and
//      SceneOptions::asset_folders.
//   2. Check elements and assets, since the files may be untrusted, and give the assets file names
//      without folders.
//   3. Set the steering rate, the compiler's defaults and the timestep.
//   4. Record the line of each element in the car's file, so that error messages can name the line.
// A scene is trusted if all files of the scene are shipped with Trackbed; the files are recognized
// by their SHA-256.
namespace trackbed {

/// Returns the folder that contains models/ and scenarios/, for programs without a data folder next
/// to the executable (cmake/Data.cmake).
const char* PlaceOfData();

namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

[[noreturn]] void Fail(const fs::path& file, int line, std::string message) {
  throw InputError(Problem{file.string(), line, 0, "", std::move(message)});
}

std::string XmlErrorText(const XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "element not closed, or closed by another name";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "attribute not of the form name=\"value\", given twice, or cut off";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
      return "text without a following element";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "comment not closed by -->";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
      return "CDATA section not closed by ]]>";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
      return "declaration <?...?> not closed or not at the start";
    case tinyxml2::XML_ERROR_PARSING_UNKNOWN:
      return "declaration <!...> not closed";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested too deeply";
    default:
      return "element not of the form <name attribute=\"value\">";
  }
}

/// Removes text nodes from an XML document, since MJCF consists only of elements and attributes.
void RemoveText(tinyxml2::XMLNode& parent) {
  for (tinyxml2::XMLNode *node = parent.FirstChild(), *next = nullptr; node != nullptr;
       node = next) {
    next = node->NextSibling();
    if (node->ToText() != nullptr) {
      parent.DeleteChild(node);
    } else {
      RemoveText(*node);
    }
  }
}

/// Whether `content` equals that of a file shipped with Trackbed.
bool IsShipped(std::string_view content) {
  const std::string hash = Sha256(content);
  return std::find(kShippedHashes.begin(), kShippedHashes.end(), hash) != kShippedHashes.end();
}

/// Reads the XML file `file` into `document`. Sets `shipped` to false if the file is not shipped
/// with Trackbed.
void Load(const fs::path& file, XMLDocument& document, bool& shipped) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    Fail(file, 0, "no such file");
  }
  // Maximum size of a model file [bytes]; parsing a file of this size takes 400 MB of memory.
  constexpr std::size_t kMaxModelBytes = std::size_t{16} << 20U;
  const std::string text = ReadFile(file, kMaxModelBytes);
  shipped = shipped && IsShipped(text);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    if (document.ErrorID() == tinyxml2::XML_ERROR_EMPTY_DOCUMENT) {
      Fail(file, 0, "the file is empty; expected a <mujoco> element");
    }
    // If the text is truncated, tinyxml2 reports a line number after the last line.
    const auto lines = std::count(text.begin(), text.end(), '\n') + (text.ends_with('\n') ? 0 : 1);
    const int line = std::min(document.ErrorLineNum(), static_cast<int>(lines));
    Fail(file, line, "not XML: " + XmlErrorText(document));
  }
  if (document.RootElement() == nullptr) {
    Fail(file, 1, "no root element");
  }
  RemoveText(document);
}

/// Path of the car's file, and the folders from which the file may include other files.
struct Origin {
  fs::path file;
  fs::path folder;  ///< folder that contains the car's file
  const std::vector<fs::path>& others;
  bool& shipped;  ///< whether all files read so far are shipped with Trackbed
};

bool IsSameButForCase(std::string_view a, std::string_view b) {
  return a.size() == b.size() && ::strncasecmp(a.data(), b.data(), a.size()) == 0;
}

/// Resolves `name` relative to the folder of the car's file. Throws InputError, with the line of
/// `element` in `file`, if the resulting path must not be read.
fs::path Find(const fs::path& name, const Origin& origin, const fs::path& file,
              const XMLElement& element) {
  fs::path found = origin.folder / name;
  const auto fail = [&](const std::string& why) {
    Fail(file, element.GetLineNum(),
         fmt::format("<{}> refers to {}, which {}", element.Name(), found.string(), why));
  };
  if (const std::string why = ReadAccessError(name, origin.folder, origin.others); !why.empty()) {
    fail(why);
  }
  std::error_code error;
  if (!fs::is_regular_file(found, error)) {
    fail("does not exist");
  }
  if (fs::file_size(found, error) > kMaxAssetBytes) {
    fail(fmt::format("has more than {} MB", kMaxAssetBytes >> 20));
  }
  return found;
}

constexpr std::string_view kInclude = "include";

/// Replaces every <include file="…"/> below `parent`, an element of `file`, by the children of the
/// included file's root element. As in MuJoCo, file names are relative to the main file, and each
/// file may be included only once.
void ResolveIncludes(XMLElement& parent, const fs::path& file, const Origin& origin,
                     std::set<fs::path>& included) {
  for (XMLElement* child = parent.FirstChildElement(); child != nullptr;) {
    XMLElement* next = child->NextSiblingElement();
    if (child->Name() != kInclude && IsSameButForCase(child->Name(), kInclude)) {
      // Other spellings of <include>, such as upper case, are rejected; MuJoCo would accept them
      // and open the file.
      Fail(file, child->GetLineNum(), fmt::format("<{}> must be written <include>", child->Name()));
    }
    if (child->Name() == kInclude) {
      const char* name = child->Attribute("file");
      if (name == nullptr) {
        Fail(file, child->GetLineNum(), "<include> without a file");
      }
      const fs::path other = Find(name, origin, file, *child);
      if (!included.insert(fs::weakly_canonical(other)).second) {
        Fail(file, child->GetLineNum(), fmt::format("{} is included twice", name));
      }
      XMLDocument document;
      Load(other, document, origin.shipped);
      ResolveIncludes(*document.RootElement(), other, origin, included);
      tinyxml2::XMLNode* last = child;
      for (const XMLElement* element = document.RootElement()->FirstChildElement();
           element != nullptr; element = element->NextSiblingElement()) {
        last = parent.InsertAfterChild(last, element->DeepClone(parent.GetDocument()));
      }
      parent.DeleteChild(child);
    } else {
      ResolveIncludes(*child, file, origin, included);
    }
    child = next;
  }
}

/// Calls `call` for `element` and all elements below it, in document order.
template <typename Call>
void ForEachElement(const XMLElement& element, const Call& call) {
  call(element);
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    ForEachElement(*child, call);
  }
}

/// Returns the value of an attribute in the last <compiler> element that sets this attribute. In
/// MuJoCo, later <compiler> elements override earlier ones.
std::string CompilerAttribute(const XMLElement& root, const char* name) {
  std::string value;
  for (const XMLElement* compiler = root.FirstChildElement("compiler"); compiler != nullptr;
       compiler = compiler->NextSiblingElement("compiler")) {
    if (const char* set = compiler->Attribute(name)) {
      value = set;
    }
  }
  return value;
}

/// Collects the files that assets refer to, and replaces the references by plain file names. After
/// the replacement, the composed model and its assets can be written into a common folder.
void GatherAssets(XMLElement& root, const Origin& origin, Scene& scene) {
  std::size_t bytes = 0;
  const fs::path mesh_folder = CompilerAttribute(root, "meshdir");
  const fs::path texture_folder = CompilerAttribute(root, "texturedir");
  static constexpr std::array kFileAttributes{"file",     "fileright", "fileup",  "fileleft",
                                              "filedown", "filefront", "fileback"};
  for (XMLElement* section = root.FirstChildElement("asset"); section != nullptr;
       section = section->NextSiblingElement("asset")) {
    for (XMLElement* asset = section->FirstChildElement(); asset != nullptr;
         asset = asset->NextSiblingElement()) {
      const std::string_view kind = asset->Name();
      const fs::path& from = kind == "texture" ? texture_folder : mesh_folder;
      for (const char* attribute : kFileAttributes) {
        const char* value = asset->Attribute(attribute);
        if (value == nullptr) {
          continue;
        }
        const fs::path source = Find(from / value, origin, origin.file, *asset);
        std::string content = ReadFile(source);
        origin.shipped = origin.shipped && IsShipped(content);
        if (const std::string why = AssetError(kind, source, content); !why.empty()) {
          Fail(origin.file, asset->GetLineNum(),
               fmt::format("<{}> refers to {}, which {}", kind, source.string(), why));
        }
        // The number in the new name distinguishes files of the same name from different folders.
        const std::string number = fmt::format("asset{}_", scene.assets.size());
        const std::string own = FileNameOf(source.filename().string());
        // Assets of a model that was composed before already have such numbered names.
        const std::string name = own.starts_with(number) ? own : number + own;
        // MuJoCo names an unnamed asset after its file, so the asset is given the name of the
        // original file.
        if (std::string_view(attribute) == "file" && asset->Attribute("name") == nullptr) {
          asset->SetAttribute("name", source.stem().c_str());
        }
        bytes += content.size();
        scene.assets.push_back({name, std::move(content)});
        asset->SetAttribute(attribute, name.c_str());
        if (scene.assets.size() > kMaxAssets) {
          Fail(origin.file, asset->GetLineNum(),
               fmt::format("more than {} files of assets", kMaxAssets));
        }
        if (bytes > kMaxTotalAssetBytes) {
          Fail(origin.file, asset->GetLineNum(),
               fmt::format("the files of assets are larger than {} MB together",
                           kMaxTotalAssetBytes >> 20U));
        }
      }
    }
  }
  for (XMLElement* compiler = root.FirstChildElement("compiler"); compiler != nullptr;
       compiler = compiler->NextSiblingElement("compiler")) {
    compiler->DeleteAttribute("meshdir");
    compiler->DeleteAttribute("texturedir");
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

/// Finds the first element named `name` in the sections `section` of the root element.
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

/// Sets the maximum steering rate in the model. For a car, this rate is the control range of the
/// steering actuator. A vehicle with differential drive has no steering actuator, so its steering
/// rate is a number under <custom>.
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
  Load(car_file, document, shipped);
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
  const Origin origin{car_file, car_file.parent_path(), options.asset_folders, shipped};
  std::set<fs::path> included{fs::weakly_canonical(car_file)};
  ResolveIncludes(root, car_file, origin, included);
  CheckElements(root, car_file);

  Scene scene;
  GatherAssets(root, origin, scene);
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
    scene.lines.push_back(element.GetLineNum());  // the line is 0 for included and added elements
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
