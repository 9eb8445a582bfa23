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

/// Compiled cars that scenarios share, because compiling a car takes as long as simulating it for
/// some seconds. Two scenarios share a car if they have the same physics model, including payload,
/// ground and obstacles. The cache is thread-safe.
class CarCache {
 public:
  /// Keeps the `capacity` most recently used models, and all models that are still referenced.
  explicit CarCache(std::size_t capacity = 64);

  /// Returns the car of LoadCar. Reads a car's file only the first time. Throws the InputErrors of
  /// LoadCar; the next call then tries again.
  std::shared_ptr<const CarModel> Load(const Scenario& scenario);

  /// Number of models compiled so far, including models that are no longer kept. A car with a
  /// payload or in a world counts as a separate model from the bare car.
  [[nodiscard]] std::size_t compiled() const;

 private:
  using Car = std::shared_ptr<const CarModel>;
  struct Slot {
    std::shared_future<Car> car;
    std::size_t last_use = 0;
  };

  /// Returns the car with that key, which the first thread that requests it compiles.
  Car Find(const std::string& key, const std::function<CarModel()>& compile);
  void ForgetOldest();

  std::size_t capacity_;
  mutable std::mutex mutex_;  // Guards the members below.
  std::unordered_map<std::string, Slot> slots_;
  std::size_t uses_ = 0;
  std::size_t compiled_ = 0;
};

}  // namespace trackbed
