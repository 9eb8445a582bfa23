#include <memory>
#include <utility>

#include "python/src/plugin_slots.h"
#include "trackbed/analysis/metric_registry.h"
#include "trackbed/analysis/plan_table.h"

namespace trackbed::python {
namespace {

struct MetricKind {};

/// Converts the result of a metric: None, or a value with the station and the time of its moment.
std::optional<MetricReading> ReadReading(const py::object& given) {
  if (given.is_none()) {
    return std::nullopt;
  }
  const auto parts = given.cast<py::tuple>();
  MetricReading reading{parts[0].cast<double>(), {.span = MetricSpan::kRun}};
  if (!parts[1].is_none()) {
    reading.at = {
        .span = MetricSpan::kMoment, .s = parts[1].cast<double>(), .t = parts[2].cast<double>()};
  }
  return reading;
}

std::optional<MetricReading> Measure(const Plugin& plugin, const MetricInput& input) {
  const auto log = std::make_shared<Columns>(ToTable(input.log));
  const Path& path = input.plan.reference.path;
  const auto planned =
      path.length() > 0.0 ? std::make_shared<Columns>(PlanTable(input.plan)) : nullptr;
  return Ask(plugin, [&] {
    return ReadReading(plugin.adapter.object().attr("measure")(log, input.log.plant, planned));
  });
}

}  // namespace

void RegisterPythonMetric(const py::dict& given) {
  auto plugin = ReadPlugin(given);
  RequireNothingRuns(*plugin);
  auto& metrics = PluginsOf<MetricKind>();
  for (auto& other : metrics) {
    if (other->name == plugin->name) {
      other = plugin;
      return;
    }
  }
  const std::size_t slot = metrics.size();
  RegisterMetric({.path = plugin->name,
                  .label = plugin->summary,
                  .unit = given["unit"].cast<std::string>(),
                  .measure =
                      [slot](const MetricInput& input) {
                        const std::shared_ptr<const Plugin> own = PluginsOf<MetricKind>()[slot];
                        return Measure(*own, input);
                      },
                  .headline = given["headline"].cast<bool>(),
                  .located = given["located"].cast<bool>()});
  metrics.push_back(std::move(plugin));
}

}  // namespace trackbed::python
