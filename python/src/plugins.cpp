#include "python/src/plugins.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>

#include "python/src/plugin_threads.h"

namespace trackbed::python {
namespace {

thread_local int depth_of_calls = 0;

std::atomic<bool> prints_tracebacks{false};

/// Identifiers of the threads that are inside of plug-ins. Only a thread with the GIL may use the
/// set, which is never destroyed.
std::set<unsigned long>& ThreadsInside() {
  static auto* const threads = new std::set<unsigned long>;
  return *threads;
}

/// Returns the text of an exception, such as "ValueError: a is 3".
std::string TextOf(const py::handle& exception) {
  const auto type = py::type::handle_of(exception).attr("__name__").cast<std::string>();
  std::string text;
  try {
    text = py::str(exception).cast<std::string>();
  } catch (py::error_already_set&) {
    text = "(the exception has no text)";
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? type : type + ": " + text;
}

PluginKey::Type TypeOf(const std::string& name) {
  static const std::map<std::string, PluginKey::Type> types{
      {"number", PluginKey::Type::kNumber}, {"optional", PluginKey::Type::kOptionalNumber},
      {"whole", PluginKey::Type::kWhole},   {"flag", PluginKey::Type::kFlag},
      {"text", PluginKey::Type::kText},     {"numbers", PluginKey::Type::kNumbers}};
  return types.at(name);
}

PluginValue ValueOf(PluginKey::Type type, const py::handle& given) {
  PluginValue value;
  if (given.is_none()) {
    return value;
  }
  switch (type) {
    case PluginKey::Type::kNumber:
      value.number = given.cast<double>();
      break;
    case PluginKey::Type::kOptionalNumber:
      value.optional_number = given.cast<double>();
      break;
    case PluginKey::Type::kWhole:
      value.whole = given.cast<int>();
      break;
    case PluginKey::Type::kFlag:
      value.flag = given.cast<bool>();
      break;
    case PluginKey::Type::kText:
      value.text = given.cast<std::string>();
      break;
    case PluginKey::Type::kNumbers:
      value.numbers = given.cast<std::vector<double>>();
      break;
  }
  return value;
}

py::object ToPython(PluginKey::Type type, const PluginValue& value) {
  switch (type) {
    case PluginKey::Type::kNumber:
      return py::cast(value.number);
    case PluginKey::Type::kOptionalNumber:
      return py::cast(value.optional_number);
    case PluginKey::Type::kWhole:
      return py::cast(value.whole);
    case PluginKey::Type::kFlag:
      return py::cast(value.flag);
    case PluginKey::Type::kText:
      return py::cast(value.text);
    case PluginKey::Type::kNumbers:
      return py::cast(value.numbers);
  }
  return py::none();
}

PluginKey ReadKey(const py::dict& given) {
  PluginKey key{.name = given["name"].cast<std::string>(),
                .unit = given["unit"].cast<std::string>(),
                .text = given["text"].cast<std::string>(),
                .type = TypeOf(given["type"].cast<std::string>()),
                .required = given["required"].cast<bool>()};
  const auto bound = [&](const char* name, double& value) {
    if (!given[name].is_none()) {
      value = given[name].cast<double>();
    }
  };
  bound("min", key.range.min);
  bound("max", key.range.max);
  bound("above", key.range.above);
  key.allowed = given["allowed"].cast<Names>();
  return key;
}

void Visit(KeyVisitor& keys, const PluginKey& own, PluginValue& value) {
  const Key key{own.name.c_str(), own.unit.c_str(), own.text.c_str()};
  const Need need = own.required ? Need::kRequired : Need::kOptional;
  switch (own.type) {
    case PluginKey::Type::kNumber:
      keys.Field(key, value.number, need, own.range);
      break;
    case PluginKey::Type::kOptionalNumber:
      keys.Field(key, value.optional_number, own.range);
      break;
    case PluginKey::Type::kWhole:
      keys.Field(key, value.whole, need, own.range);
      break;
    case PluginKey::Type::kFlag:
      keys.Field(key, value.flag, need);
      break;
    case PluginKey::Type::kText:
      keys.Field(key, value.text, need, own.allowed);
      break;
    case PluginKey::Type::kNumbers:
      keys.Field(key, value.numbers, need, own.range);
      break;
  }
}

}  // namespace

Kept::Kept(py::object object)
    : object_(new py::object(std::move(object)), [](const py::object* kept) {
        const py::gil_scoped_acquire gil;
        delete kept;
      }) {}

void VisitPlugin(KeyVisitor& keys, const std::shared_ptr<const Plugin>& current,
                 PluginOptions& options) {
  if (options.plugin == nullptr) {
    options = {current, current->defaults};
  }
  for (std::size_t i = 0; i < options.values.size(); ++i) {
    Visit(keys, options.plugin->keys[i], options.values[i]);
  }
}

py::dict KeywordsOf(const PluginOptions& options) {
  py::dict keywords;
  for (std::size_t i = 0; i < options.values.size(); ++i) {
    const PluginKey& key = options.plugin->keys[i];
    keywords[key.name.c_str()] = ToPython(key.type, options.values[i]);
  }
  return keywords;
}

std::shared_ptr<const Plugin> ReadPlugin(const py::dict& given) {
  auto plugin = std::make_shared<Plugin>();
  plugin->kind = given["kind"].cast<std::string>();
  plugin->name = given["name"].cast<std::string>();
  plugin->summary = given["summary"].cast<std::string>();
  plugin->place = given["place"].cast<std::string>();
  plugin->adapter = Kept(given["adapter"]);
  for (const py::handle& key : given["keys"].cast<py::list>()) {
    const auto own = key.cast<py::dict>();
    plugin->keys.push_back(ReadKey(own));
    plugin->defaults.push_back(ValueOf(plugin->keys.back().type, own["default"]));
  }
  return plugin;
}

bool InsidePlugin() {
  return depth_of_calls > 0;
}

void PrintTracebacks() {
  prints_tracebacks = true;
}

PluginCall::PluginCall() {
  if (++depth_of_calls == 1) {
    ThreadsInside().insert(PyThread_get_thread_ident());
  }
}

PluginCall::~PluginCall() {
  if (--depth_of_calls == 0) {
    ThreadsInside().erase(PyThread_get_thread_ident());
  }
}

std::size_t InterruptPlugins() {
  std::size_t count = 0;
  for (const unsigned long thread : ThreadsInside()) {
    if (thread != PyThread_get_thread_ident()) {
      PyThreadState_SetAsyncExc(thread, PyExc_SystemExit);
      ++count;
    }
  }
  return count;
}

void ForgetOtherPlugins() {
  ThreadsInside().clear();
  if (InsidePlugin()) {
    ThreadsInside().insert(PyThread_get_thread_ident());
  }
}

void RequireNothingRuns(const Plugin& plugin) {
  if (RunningFunction::Count() > 0) {
    throw std::runtime_error(fmt::format(
        "{} '{}' cannot be registered while trackbed runs {}; register plug-ins before the first "
        "run, for example at the top of a module",
        plugin.kind, plugin.name, InsidePlugin() ? "a plug-in" : "on another thread"));
  }
}

void ThrowPluginError(const Plugin& plugin, py::error_already_set& error) {
  const py::object exception = error.value();
  if (error.trace()) {
    PyException_SetTraceback(exception.ptr(), error.trace().ptr());
  }
  const std::string text =
      fmt::format("{} '{}' ({}): {}", plugin.kind, plugin.name, plugin.place, TextOf(exception));
  if (!py::isinstance(exception, PyExc_Exception)) {
    throw PluginInterrupt(text, Kept(exception));
  }
  if (prints_tracebacks) {
    py::module_::import("trackbed._signatures").attr("print_traceback")(exception);
  }
  throw PluginError(text, Kept(exception));
}

std::vector<double> ToNumbers(const py::handle& numbers) {
  return numbers.cast<std::vector<double>>();
}

}  // namespace trackbed::python
