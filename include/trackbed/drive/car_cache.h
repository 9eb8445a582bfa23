#pragma once

#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Cache of compiled car models that scenarios share. The cache saves time, because compiling a car
/// takes as long as simulating some seconds of driving. Two scenarios share a car if they have the
/// same physics model, including payload, ground and obstacles. The cache is thread-safe.
class CarCache {
 public:
  /// The cache keeps the `capacity` most recently used models. When the cache drops a model, the
  /// model stays valid for callers that still use the model.
  explicit CarCache(std::size_t capacity = 64);

  /// Returns the same car model as LoadCar. Reads a car's file only if the car is not in the cache.
  /// If the car cannot be loaded, throws the same InputError as LoadCar; the next call then tries
  /// again to load the car.
  std::shared_ptr<const CarModel> Load(const Scenario& scenario);

  /// Returns the number of models compiled so far, including models that the cache has dropped. A
  /// car with a payload, or in a world with ground or obstacles, counts as a separate model from
  /// the bare car.
  [[nodiscard]] std::size_t compiled() const;

 private:
  using Car = std::shared_ptr<const CarModel>;
  struct Slot {
    std::shared_future<Car> car;
    std::size_t last_use = 0;
  };

  /// Returns the car model with the cache key `key`. If the cache has no such model, the first
  /// thread that requests the model compiles the model.
  Car Find(const std::string& key, const std::function<CarModel()>& compile);
  void ForgetOldest();

  std::size_t capacity_;
  // Protects the members of the cache against simultaneous access by several threads.
  mutable std::mutex mutex_;
  std::unordered_map<std::string, Slot> slots_;
  std::size_t uses_ = 0;
  std::size_t compiled_ = 0;
};

}  // namespace trackbed
