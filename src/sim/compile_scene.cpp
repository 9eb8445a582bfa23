#include "trackbed/sim/compile_scene.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <regex>

#include "src/sim/mujoco_compat.h"
#include "src/sim/scene_xml.h"
#include "src/sim/sub_process.h"
#include "trackbed/core/classic_locale.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed {
namespace {

constexpr std::size_t kGigabyte = std::size_t{1} << 30;
/// Resource limits for the separate process that compiles a model.
constexpr std::size_t kMemory = 2 * kGigabyte;  // Maximum memory of the compiling process [bytes].
constexpr int kSeconds = 60;                    // Maximum processor time of the compiling process
                                                // [s].
/// Maximum size of a compiled model [bytes].
constexpr std::int64_t kMaxBytes = kGigabyte;

struct VfsDeleter {
  void operator()(mjVFS* vfs) const {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};
using Vfs = std::unique_ptr<mjVFS, VfsDeleter>;

Vfs MakeVfs() {
  Vfs vfs(new mjVFS);  // allocated on the heap, because an mjVFS is too large for the stack
  mj_defaultVFS(vfs.get());
  return vfs;
}

void Add(mjVFS& vfs, const std::string& file, const std::string& content) {
  TRACKBED_CHECK(mj::AddToVfs(vfs, file, content) == 0, "cannot hand {} to MuJoCo", file);
}

/// A compiled model or, if the compilation failed, the error message of MuJoCo's compiler.
struct Compiled {
  MujocoModel model;
  std::string error;
};

Compiled CompileInProcess(const std::string& xml, const std::vector<SceneAsset>& assets) {
  // set the classic locale, because MuJoCo parses numbers with the program's global locale
  const ClassicLocale locale;
  const Vfs vfs = MakeVfs();
  Add(*vfs, "model.xml", xml);
  for (const SceneAsset& asset : assets) {
    Add(*vfs, asset.name, asset.content);
  }
  std::array<char, 1000> message{};
  Compiled compiled;
  try {
    compiled.model.reset(
        mj_loadXML("model.xml", vfs.get(), message.data(), static_cast<int>(message.size())));
    if (compiled.model == nullptr) {
      compiled.error = message.data();
    }
  } catch (const RunError& error) {
    compiled.error = error.what();
  }
  return compiled;
}

std::string SizeLimitMessage() {
  return fmt::format("takes more than {} MB of memory", kMemory >> 20);
}

// The first byte that the compiling process sends is one of these status letters. After the status
// letter, the compiling process sends the bytes of the model, or the text of an error.
constexpr char kModelFollows = 'M';
constexpr char kErrorFollows = 'E';

/// Runs in the compiling process: compiles the model and tries the calls in which MuJoCo would
/// crash if the model is invalid.
std::string CompileAndTry(const std::string& xml, const std::vector<SceneAsset>& assets) try {
  const Compiled compiled = CompileInProcess(xml, assets);
  const auto fail = [](const std::string& text) { return kErrorFollows + text; };
  if (compiled.model == nullptr) {
    return fail(compiled.error);
  }
  const std::int64_t size = mj::SizeOf(*compiled.model);
  if (size < 0 || size > kMaxBytes) {
    return fail(fmt::format("the compiled model takes more than {} MB", kMaxBytes >> 20));
  }
  const MujocoData data = MakeMujocoData(*compiled.model);
  mj_forward(compiled.model.get(), data.get());
  std::string result(1 + static_cast<std::size_t>(size), kModelFollows);
  mj_saveModel(compiled.model.get(), nullptr, result.data() + 1, static_cast<int>(size));
  return result;
} catch (const std::bad_alloc&) {
  return kErrorFollows + SizeLimitMessage();
} catch (const std::exception& error) {
  return kErrorFollows + std::string(error.what());
}

Compiled CompileInSubProcess(const std::string& xml, const std::vector<SceneAsset>& assets) {
  const SubProcessOutcome outcome =
      InSubProcess([&] { return CompileAndTry(xml, assets); }, kMemory, kSeconds);
  if (!outcome.finished) {
    return {nullptr, fmt::format("MuJoCo's compiler failed: {}", outcome.cause)};
  }
  const std::string content = outcome.result.substr(1);
  if (outcome.result.front() == kErrorFollows) {
    // MuJoCo's error message for a lack of memory differs between versions.
    static const std::regex no_memory("[Cc]ould not (allocate memory|create mjData)");
    return {nullptr, std::regex_search(content, no_memory) ? SizeLimitMessage() : content};
  }
  const Vfs vfs = MakeVfs();
  Add(*vfs, "model.mjb", content);
  MujocoModel model(mj_loadModel("model.mjb", vfs.get()));
  TRACKBED_CHECK(model != nullptr, "a compiled model of {} bytes does not load", content.size());
  return {std::move(model), ""};
}

struct CompileError {
  std::string text;  ///< Error message of the compiler, without line breaks.
  int line = 0;      ///< Line of the composed model to which the error refers; 0 if unknown.
};

/// Splits an error text of MuJoCo into the message and the line number. At the end of its error
/// text, MuJoCo names the element: "Element 'joint', line 46" or "Object name = rack, id = 1, line
/// = 63, column = -1"; since MuJoCo 3.1, "Element name 'rack', id 1, line 63".
CompileError ParseMujocoError(const std::string& message) {
  static const std::regex kind("^(XML )?Error: (Error: )?(Schema violation: )?");
  static const std::regex place(
      R"re(\s+(Element '([^']*)'|(Element name '|Object name = )(.*?)'?, id )[^\n]*line (= )?(-?\d+))re");
  CompileError error{std::regex_replace(message, kind, "")};
  if (std::smatch found; std::regex_search(error.text, found, place)) {
    error.line = std::max(0, std::stoi(found[6]));
    const std::string where = found[2].matched        ? fmt::format(" (<{}>)", found[2].str())
                              : found[4].length() > 0 ? fmt::format(" ('{}')", found[4].str())
                                                      : "";
    error.text = error.text.substr(0, static_cast<std::size_t>(found.position())) + where;
  }
  std::replace(error.text.begin(), error.text.end(), '\n', ' ');
  return error;
}

/// A word of MJCF that older versions of MuJoCo do not know.
struct NewerWord {
  std::string_view word;
  int version;  ///< First MuJoCo version that knows the word, encoded like mjVERSION_HEADER (222:
                ///< 2.2.2, 3010000: 3.10.0).
  const char* text;
};

constexpr std::array kNewerWords{NewerWord{"autolimits", 222, "2.2.2"},
                                 NewerWord{"shellinertia", 222, "2.2.2"},
                                 NewerWord{"implicitfast", 233, "2.3.3"},
                                 NewerWord{"actuatorfrcrange", 237, "2.3.7"},
                                 NewerWord{"actuatorfrclimited", 237, "2.3.7"},
                                 NewerWord{"flexcomp", 300, "3.0.0"},
                                 NewerWord{"frame", 310, "3.1.0"},
                                 NewerWord{"inheritrange", 313, "3.1.3"},
                                 NewerWord{"replicate", 315, "3.1.5"},
                                 NewerWord{"dampratio", 316, "3.1.6"},
                                 NewerWord{"timeconst", 316, "3.1.6"}};

/// Returns the version of MuJoCo that a model needs, if the error of the compiler names a word that
/// the linked version does not know; otherwise empty.
std::string VersionHint(const std::string& error) {
  static const std::regex unknown(
      "(unrecognized (attribute|element)|invalid keyword):? ?[^'<]*['<]([A-Za-z]+)['>]");
  std::smatch found;
  if (!std::regex_search(error, found, unknown)) {
    return "";
  }
  for (const NewerWord& newer : kNewerWords) {
    if (newer.word == found[3].str() && newer.version > mjVERSION_HEADER) {
      return fmt::format("; '{}' needs MuJoCo {} or newer, this program has {}", newer.word,
                         newer.text, PhysicsVersion());
    }
  }
  return "";
}

/// Whether the bodies of two models have the same masses, inertias and centers of mass.
bool HaveSameMasses(const mjModel& a, const mjModel& b) {
  const auto same = [&](const mjtNum* of_a, const mjtNum* of_b, int numbers) {
    return std::equal(of_a, of_a + std::ptrdiff_t{numbers} * a.nbody, of_b);
  };
  return a.nbody == b.nbody && same(a.body_mass, b.body_mass, 1) &&
         same(a.body_inertia, b.body_inertia, 3) && same(a.body_ipos, b.body_ipos, 3) &&
         same(a.body_iquat, b.body_iquat, 4);
}

}  // namespace

MujocoModel CompileScene(const Scene& scene, const std::string& name, Looks looks) {
  // checks that MuJoCo's library and headers have the same version
  static_cast<void>(PhysicsVersion());
  // Only one thread compiles at a time: a process that is forked while another thread compiles
  // would wait forever for MuJoCo's lock.
  static std::mutex compiling;
  const std::lock_guard lock(compiling);
  const MujocoErrorScope errors;
  const auto compile = [&](const std::string& xml) {
    return scene.trusted ? CompileInProcess(xml, scene.assets)
                         : CompileInSubProcess(xml, scene.assets);
  };
  const bool discard = looks == Looks::kDiscarded;
  const bool is_mass_given = discard && GivesAllMasses(scene.xml);
  Compiled compiled = compile(is_mass_given ? DiscardLooks(scene.xml) : scene.xml);
  if (compiled.model == nullptr) {
    const CompileError error = ParseMujocoError(compiled.error);
    throw InputError(
        Problem{.file = name,
                .line = LineInCarFile(scene, error.line),
                .message = "does not compile: " + error.text + VersionHint(error.text)});
  }
  if (discard && !is_mass_given) {
    Compiled bare = compile(DiscardLooks(scene.xml));
    if (bare.model != nullptr && HaveSameMasses(*compiled.model, *bare.model)) {
      compiled = std::move(bare);
    }
  }
  mj::SetCommonOptions(*compiled.model);
  return std::move(compiled.model);
}

}  // namespace trackbed
