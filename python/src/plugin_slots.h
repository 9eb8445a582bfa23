#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <utility>

#include "python/src/plugins.h"

/// Numbered places for the plug-ins of a kind. The registries of planners and controllers
/// distinguish methods by the types of their options, and call functions without a context.
/// Therefore each place has a separate options type and separate functions.
namespace trackbed::python {

/// Largest number of planners, and of controllers, that Python code can register.
inline constexpr std::size_t kSlots = 32;

/// The plug-ins of a kind, in the order of their registration. `Kind` only distinguishes the kinds.
template <typename Kind>
std::vector<std::shared_ptr<const Plugin>>& PluginsOf() {
  // Never destroyed, because threads may use plug-ins until the process ends.
  static auto* const plugins = new std::vector<std::shared_ptr<const Plugin>>;
  return *plugins;
}

template <typename Kind, std::size_t Slot>
struct SlotOptions : PluginOptions {};

template <typename Kind, std::size_t Slot>
void Visit(KeyVisitor& keys, SlotOptions<Kind, Slot>& options) {
  VisitPlugin(keys, PluginsOf<Kind>()[Slot], options);
}

/// Returns the options with the plug-in that they belong to.
template <typename Kind, std::size_t Slot>
PluginOptions Bound(const SlotOptions<Kind, Slot>& options) {
  if (options.plugin != nullptr) {
    return options;
  }
  const std::shared_ptr<const Plugin>& current = PluginsOf<Kind>()[Slot];
  return {current, current->defaults};
}

/// Registers a plug-in in the next free place, or replaces the plug-in with the same name.
/// `MakeEntry<Slot>` is a function that returns the entry of a place, for `add`.
template <typename Kind, template <std::size_t> typename MakeEntry, typename Add>
void RegisterInSlot(std::shared_ptr<const Plugin> plugin, const Add& add) {
  RequireNothingRuns(*plugin);
  auto& plugins = PluginsOf<Kind>();
  for (auto& other : plugins) {
    if (other->name == plugin->name) {
      other = std::move(plugin);
      return;
    }
  }
  if (plugins.size() == kSlots) {
    throw std::runtime_error(plugin->kind + " '" + plugin->name + "': at most " +
                             std::to_string(kSlots) +
                             " can be registered; give it the name of an earlier one, with "
                             "replace=True, or a parameter that distinguishes the variants");
  }
  constexpr auto kMake = []<std::size_t... Slot>(std::index_sequence<Slot...>) {
    return std::array{&MakeEntry<Slot>::Make...};
  }
  (std::make_index_sequence<kSlots>());
  // Plugins are never destroyed, so entries can refer to the names of the first version.
  static auto* const first_versions = new std::vector<std::shared_ptr<const Plugin>>;
  first_versions->push_back(plugin);
  plugins.push_back(plugin);
  try {
    add(kMake[plugins.size() - 1](*plugin));
  } catch (...) {
    plugins.pop_back();
    throw;
  }
}

}  // namespace trackbed::python
