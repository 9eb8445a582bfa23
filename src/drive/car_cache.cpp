#include "trackbed/drive/car_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>
#include <utility>

#include "src/drive/car_stages.h"
#include "trackbed/scenario/input_files.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Returns the cache key of a car model: a text with all data from which the model is compiled.
std::string KeyOf(const Scene& scene, const fs::path& file) {
  std::string key = fmt::format("{}\n{}", file.string(), scene.xml);
  for (const SceneAsset& asset : scene.assets) {
    key += fmt::format("\n{} of {} bytes\n{}", asset.name, asset.content.size(), asset.content);
  }
  return key;
}

}  // namespace

CarCache::CarCache(std::size_t capacity) : capacity_(capacity) {}

CarCache::Car CarCache::Load(const Scenario& scenario) {
  const fs::path file = FindModel(scenario.vehicle.model, scenario.folder);
  const auto compiled = [&](Scene scene) {
    return Find(KeyOf(scene, file), [&] { return CarModel(std::move(scene), file.string()); });
  };
  const SceneOptions options = MakeSceneOptions(scenario);
  std::string key =
      fmt::format("{} {} {}", options.timestep, options.steering_rate.value_or(0.0), file.string());
  for (const auto& [name, value] : options.tyre_numbers) {
    key += fmt::format("\n{} {}", name, value);
  }
  Car car = Find(key, [&] { return LoadBareCar(options, file); });
  if (std::optional<Scene> towing = TowingScene(scenario, *car)) {
    car = compiled(std::move(*towing));
  }
  if (std::optional<Scene> laden = LadenScene(scenario, *car)) {
    car = compiled(std::move(*laden));
  }
  if (std::optional<Scene> scene = SceneInWorld(scenario, *car)) {
    car = compiled(std::move(*scene));
  }
  return car;
}

std::size_t CarCache::compiled() const {
  const std::lock_guard lock(mutex_);
  return compiled_;
}

CarCache::Car CarCache::Find(const std::string& key, const std::function<CarModel()>& compile) {
  std::promise<Car> promise;
  std::shared_future<Car> car;
  bool is_new = false;
  {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[key];
    slot.last_use = ++uses_;
    is_new = !slot.car.valid();
    if (is_new) {
      slot.car = promise.get_future().share();
    }
    car = slot.car;
    ForgetOldest();
  }
  if (!is_new) {
    return car.get();
  }
  try {
    promise.set_value(std::make_shared<const CarModel>(compile()));
    const std::lock_guard lock(mutex_);
    ++compiled_;
  } catch (...) {
    promise.set_exception(std::current_exception());
    const std::lock_guard lock(mutex_);
    slots_.erase(key);
  }
  return car.get();
}

void CarCache::ForgetOldest() {
  if (slots_.size() > capacity_) {
    slots_.erase(std::min_element(slots_.begin(), slots_.end(), [](const auto& a, const auto& b) {
      return a.second.last_use < b.second.last_use;
    }));
  }
}

}  // namespace trackbed
