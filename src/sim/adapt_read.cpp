#include "src/sim/adapt_read.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <string_view>

#include "src/sim/asset_check.h"
#include "src/sim/model_check.h"
#include "src/sim/scene_xml.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/file_name.h"
#include "trackbed/sim/compile_scene.h"
#include "trackbed/sim/mujoco_error.h"
#include "trackbed/sim/scene.h"

// Reads an MJCF or URDF model that was written for another program. ComposeScene reads MJCF files.
// MuJoCo's own URDF reader reads URDF files. Before MuJoCo reads a URDF file, mesh paths are
// replaced by plain names of checked files. Meshes that MuJoCo cannot read are removed from the
// URDF text.
namespace trackbed::adapt {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

/// Maximum size of a URDF file [bytes], as for MJCF.
constexpr std::size_t kMaxUrdfBytes = std::size_t{16} << 20U;
/// Maximum nesting depth of URDF elements, limited because MuJoCo's reader is recursive.
constexpr int kMaxUrdfLinks = 2000;

[[noreturn]] void FailRead(const fs::path& file, int line, std::string message) {
  throw InputError(Problem{.file = file.string(), .line = line, .message = std::move(message)});
}

/// Returns the first element, `parent` or an element inside it, that xacro would replace; null if
/// xacro would replace no element.
const XMLElement* FindXacro(const XMLElement& parent) {
  if (std::string_view(parent.Name()).starts_with("xacro:")) {
    return &parent;
  }
  for (const auto* attribute = parent.FirstAttribute(); attribute != nullptr;
       attribute = attribute->Next()) {
    if (std::string_view(attribute->Value()).find("${") != std::string_view::npos ||
        std::string_view(attribute->Value()).find("$(") != std::string_view::npos) {
      return &parent;
    }
  }
  for (const XMLElement* child = parent.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (const XMLElement* found = FindXacro(*child)) {
      return found;
    }
  }
  return nullptr;
}

/// Reads the meshes of a URDF file and replaces their names by names of assets.
class MeshReader {
 public:
  MeshReader(const fs::path& file, const AdaptOptions& options, Scene& scene)
      : own_(fs::absolute(file).parent_path()), folders_(options.asset_folders), scene_(scene) {
    std::error_code error;
    folders_.push_back(own_);
    // A package is the folder with package.xml. Allow reading from the package of the URDF file,
    // because its meshes are in other folders of the package.
    for (fs::path folder = own_; folder.has_relative_path(); folder = folder.parent_path()) {
      if (fs::is_regular_file(folder / "package.xml", error)) {
        folders_.push_back(folder);
        break;
      }
    }
  }

  /// Returns the reason why MuJoCo cannot use the mesh; empty if the mesh has become an asset.
  std::string Replace(XMLElement& mesh) {
    const char* name = mesh.Attribute("filename");
    if (name == nullptr) {
      return "has no filename";
    }
    if (const auto known = names_.find(name); known != names_.end()) {
      mesh.SetAttribute("filename", known->second.c_str());
      return "";
    }
    const fs::path path = Locate(name);
    std::error_code error;
    if (path.empty() || !fs::is_regular_file(path, error)) {
      const std::string_view uri(name);
      return uri.starts_with("package://") || uri.starts_with("model://")
                 ? "does not exist beside the file or in its package, the folder with package.xml; "
                   "name the folder of the package by --allow-assets"
                 : "does not exist";
    }
    if (std::string why = ReadAccessError(path, own_, folders_); !why.empty()) {
      return why;
    }
    const auto size = fs::file_size(path, error);
    if (size > kMaxAssetBytes || bytes_ + size > kMaxTotalAssetBytes ||
        scene_.assets.size() >= kMaxAssets) {
      return fmt::format("exceeds the {} MB of one mesh, or the {} MB of {} meshes together",
                         kMaxAssetBytes >> 20U, kMaxTotalAssetBytes >> 20U, kMaxAssets);
    }
    std::string content = ReadFile(path);
    if (std::string why = AssetError("mesh", path, content); !why.empty()) {
      return why;
    }
    bytes_ += content.size();
    const std::string own =
        fmt::format("asset{}_{}", scene_.assets.size(), FileNameOf(path.filename().string()));
    scene_.assets.push_back({own, std::move(content)});
    mesh.SetAttribute("filename", own.c_str());
    names_.emplace(name, own);
    return "";
  }

 private:
  /// Returns the path of a mesh file. The mesh name is relative to the URDF file or, for
  /// package://NAME/…, to the package.
  [[nodiscard]] fs::path Locate(std::string_view name) const {
    for (const std::string_view scheme : {"package://", "model://"}) {
      if (name.starts_with(scheme)) {
        const std::string_view rest = name.substr(scheme.size());
        const std::string_view below = rest.substr(std::min(rest.find('/'), rest.size() - 1) + 1);
        std::error_code error;
        for (const fs::path& folder : folders_) {
          for (const fs::path& found : {folder / below, folder / rest}) {
            if (fs::is_regular_file(found, error)) {
              return found;
            }
          }
        }
        return {};
      }
    }
    if (name.starts_with("file://")) {
      name.remove_prefix(7);
    }
    return own_ / name;
  }

  fs::path own_;                   // Folder of the URDF file, absolute.
  std::vector<fs::path> folders_;  // Folders from which meshes of the URDF file may be read.
  Scene& scene_;
  std::map<std::string, std::string> names_;  // Name of a mesh in the URDF file, and name of the
                                              // asset made from the mesh.
  std::size_t bytes_ = 0;
};

/// Removes any text after the three numbers of a mesh's scale, because some programs write a fourth
/// number.
void KeepThreeScales(XMLElement& mesh) {
  std::array<double, 3> scale{};
  const char* text = mesh.Attribute("scale");
  if (text != nullptr &&
      std::sscanf(text, "%lf %lf %lf", scale.data(), scale.data() + 1, scale.data() + 2) == 3) {
    mesh.SetAttribute("scale", Numbers({scale[0], scale[1], scale[2]}).c_str());
  }
}

/// Removes the <visual> and <collision> elements below `link` whose mesh MuJoCo cannot read.
void ReplaceMeshes(XMLElement& link, MeshReader& reader, std::set<std::string>& dropped) {
  for (XMLElement *shape = link.FirstChildElement(), *next = nullptr; shape != nullptr;
       shape = next) {
    next = shape->NextSiblingElement();
    XMLElement* geometry = shape->FirstChildElement("geometry");
    XMLElement* mesh = geometry == nullptr ? nullptr : geometry->FirstChildElement("mesh");
    if (mesh == nullptr) {
      continue;
    }
    KeepThreeScales(*mesh);
    if (const std::string why = reader.Replace(*mesh); !why.empty()) {
      const char* name = mesh->Attribute("filename");
      dropped.insert(fmt::format("{} {}", name == nullptr ? "a mesh" : name, why));
      link.DeleteChild(shape);
    }
  }
}

/// Gives a link without mass 1e-6 kg, and returns whether the link had no mass. In URDF, a link
/// without <inertial> has no mass. MuJoCo would compute a mass from the link's shapes, with the
/// density of water.
bool GiveLeastMass(XMLElement& link) {
  XMLElement* inertial = link.FirstChildElement("inertial");
  const XMLElement* mass = inertial == nullptr ? nullptr : inertial->FirstChildElement("mass");
  if (mass != nullptr && mass->DoubleAttribute("value", 1.0) != 0.0) {
    return false;
  }
  if (inertial != nullptr) {
    link.DeleteChild(inertial);
  }
  inertial = link.InsertNewChildElement("inertial");
  inertial->InsertNewChildElement("mass")->SetAttribute("value", "1e-6");
  XMLElement* inertia = inertial->InsertNewChildElement("inertia");
  for (const char* name : {"ixx", "iyy", "izz"}) {
    inertia->SetAttribute(name, "1e-10");
  }
  for (const char* name : {"ixy", "ixz", "iyz"}) {
    inertia->SetAttribute(name, "0");
  }
  return true;
}

/// Rejects elements that would overflow a buffer of MuJoCo.
void CheckUrdfElements(const XMLElement& element, const fs::path& file) {
  if (const std::string why = ElementError(element); !why.empty()) {
    FailRead(file, element.GetLineNum(), fmt::format("<{}>: {}", element.Name(), why));
  }
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    CheckUrdfElements(*child, file);
  }
}

/// Sets MuJoCo's options for URDF: every link stays a body and keeps its <inertial>, and visual
/// geometry is kept.
void SetUrdfCompiler(XMLElement& robot) {
  XMLElement* extension = robot.FirstChildElement("mujoco");
  if (extension == nullptr) {
    extension = robot.InsertNewChildElement("mujoco");
  }
  XMLElement* compiler = extension->FirstChildElement("compiler");
  if (compiler == nullptr) {
    compiler = extension->InsertNewChildElement("compiler");
  }
  compiler->DeleteAttribute("meshdir");
  compiler->DeleteAttribute("inertiafromgeom");
  compiler->SetAttribute("strippath", true);
  compiler->SetAttribute("fusestatic", false);
  compiler->SetAttribute("discardvisual", false);
}

Scene ComposeUrdf(const fs::path& file, XMLDocument& document, const AdaptOptions& options,
                  std::vector<std::string>& notes) {
  XMLElement& robot = *document.RootElement();
  if (const XMLElement* xacro = FindXacro(robot)) {
    FailRead(file, xacro->GetLineNum(),
             fmt::format("<{}>: the file is input of xacro, not URDF; expand it by "
                         "`xacro {} > car.urdf` and adapt car.urdf",
                         xacro->Name(), file.filename().string()));
  }
  Scene scene;
  MeshReader reader(file, options, scene);
  std::set<std::string> dropped;
  std::vector<std::string> massless;
  int links = 0;
  for (XMLElement *part = robot.FirstChildElement(), *next = nullptr; part != nullptr;
       part = next) {
    next = part->NextSiblingElement();
    const std::string_view kind = part->Name();
    if (kind == "link") {
      ReplaceMeshes(*part, reader, dropped);
      if (GiveLeastMass(*part)) {
        const char* name = part->Attribute("name");
        massless.push_back(fmt::format("'{}'", name == nullptr ? "" : name));
      }
      if (++links > kMaxUrdfLinks) {
        FailRead(file, part->GetLineNum(),
                 fmt::format("more than {} links; allowed are {}", kMaxUrdfLinks, kMaxUrdfLinks));
      }
    } else if (kind != "joint" && kind != "material" && kind != "mujoco") {
      robot.DeleteChild(part);  // removes elements such as <gazebo>, which describe no parts of the
                                // model
    }
  }
  CheckUrdfElements(robot, file);
  SetUrdfCompiler(robot);
  scene.xml = Print(document);
  for (const std::string& mesh : dropped) {
    notes.push_back(fmt::format("mesh dropped: {}", mesh));
  }
  if (!massless.empty()) {
    constexpr std::size_t kNamed = 6;
    const std::size_t more = massless.size() - std::min(massless.size(), kNamed);
    massless.resize(massless.size() - more);
    notes.push_back(fmt::format(
        "links without <inertial> or with a mass of 0 get 1e-6 kg each: {}{}; add the masses of "
        "the real parts to the file",
        fmt::join(massless, ", "), more == 0 ? "" : fmt::format(" and {} more", more)));
  }
  return scene;
}

/// Returns the scene with MuJoCo's remedies for bodies without mass or with impossible inertia.
/// If `drops_visual` is true, MuJoCo discards the visual geometry of URDF, whose meshes may have no
/// volume.
Scene WithRemedies(const Scene& scene, bool is_urdf, bool drops_visual) {
  Scene own = scene;
  XMLDocument document;
  ParseComposed(scene.xml, document);
  XMLElement& root = *document.RootElement();
  XMLElement* parent = is_urdf ? root.FirstChildElement("mujoco") : &root;
  XMLElement* compiler =
      is_urdf ? parent->FirstChildElement("compiler") : parent->InsertNewChildElement("compiler");
  compiler->SetAttribute("boundmass", "1e-6");
  compiler->SetAttribute("boundinertia", "1e-10");
  compiler->SetAttribute("balanceinertia", true);
  if (drops_visual) {
    compiler->SetAttribute("discardvisual", true);
  }
  own.xml = Print(document);
  own.trusted = false;
  return own;
}

MujocoModel CompileFound(const Scene& scene, const std::string& name, bool is_urdf,
                         std::vector<std::string>& notes) {
  try {
    return CompileScene(scene, name, Looks::kKept);
  } catch (const InputError& error) {
    const std::string text = error.what();
    if (text.find("inertia") == std::string::npos && text.find("mass") == std::string::npos &&
        text.find("mesh") == std::string::npos) {
      throw;
    }
    // Keep visual geometry if MuJoCo can compile it, because wheels in files for display have no
    // other geometry.
    for (const bool drops_visual : {false, true}) {
      try {
        MujocoModel model =
            CompileScene(WithRemedies(scene, is_urdf, drops_visual), name, Looks::kKept);
        notes.push_back(fmt::format(
            "MuJoCo refuses the file ({}); read with boundmass 1e-6 kg, boundinertia "
            "1e-10 kg m^2 and balanceinertia{}",
            error.problems().front().message, drops_visual ? ", without visual geometry" : ""));
        return model;
      } catch (const InputError&) {
        if (drops_visual || !is_urdf) {
          throw error;
        }
      }
    }
    throw;
  }
}

}  // namespace

FoundModel ReadFound(const fs::path& file, const AdaptOptions& options) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    FailRead(file, 0, "no such file");
  }
  FoundModel found;
  found.file = file.string();
  XMLDocument document;
  const std::string text = ReadFile(file, kMaxUrdfBytes);
  const bool parses = document.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS;
  const XMLElement* root = parses ? document.RootElement() : nullptr;
  const std::string_view kind = root == nullptr ? "" : root->Name();
  if (kind == "sdf") {
    FailRead(file, root->GetLineNum(),
             "root element is <sdf>; must be <mujoco> (MJCF) or <robot> (URDF). Give the URDF that "
             "the SDF was made of, or convert it");
  }
  found.is_urdf = kind == "robot";
  const Scene scene = found.is_urdf ? ComposeUrdf(file, document, options, found.notes)
                                    : ComposeScene(file, {.asset_folders = options.asset_folders});
  found.model = CompileFound(scene, found.file, found.is_urdf, found.notes);
  const MujocoErrorScope errors;
  CheckModel(*found.model, found.file);
  found.data = MakeMujocoData(*found.model);
  mj_forward(found.model.get(), found.data.get());
  return found;
}

}  // namespace trackbed::adapt
