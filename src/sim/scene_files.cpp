#include "src/sim/scene_files.h"

#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "shipped_models.h"
#include "src/sim/asset_check.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/file_name.h"
#include "trackbed/core/foreign_content.h"
#include "trackbed/core/hash.h"

namespace trackbed::scene_files {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

namespace {

/// Removes text nodes from the XML document of a model, since MJCF consists only of elements and
/// attributes.
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

/// Whether the text `content` equals the content of a file shipped with Trackbed.
bool IsShipped(std::string_view content) {
  const std::string hash = Sha256(content);
  return std::find(kShippedHashes.begin(), kShippedHashes.end(), hash) != kShippedHashes.end();
}

bool IsSameButForCase(std::string_view a, std::string_view b) {
  return a.size() == b.size() && ::strncasecmp(a.data(), b.data(), a.size()) == 0;
}

/// Resolves the file name `name` relative to the folder of the car's file. If the resulting file
/// must not be read, throws InputError with the line of `element` in `file`.
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

}  // namespace

void Fail(const fs::path& file, int line, std::string message) {
  throw InputError(Problem{file.string(), line, 0, "", std::move(message)});
}

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
    // If the XML text is truncated, tinyxml2 reports a line number after the last line.
    const auto lines = std::count(text.begin(), text.end(), '\n') + (text.ends_with('\n') ? 0 : 1);
    const int line = std::min(document.ErrorLineNum(), static_cast<int>(lines));
    Fail(file, line, XmlProblem(text, document.ErrorName()));
  }
  if (document.RootElement() == nullptr) {
    Fail(file, 1, "no root element");
  }
  RemoveText(document);
}

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
        // The number in the new asset file name distinguishes files of the same name from different
        // folders.
        const std::string number = fmt::format("asset{}_", scene.assets.size());
        const std::string own = FileNameOf(source.filename().string());
        // The assets of a model that was composed earlier already have numbered names.
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

}  // namespace trackbed::scene_files
