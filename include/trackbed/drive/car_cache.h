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

/// Compiled cars shared between scenarios: compiling a car takes as long as simulating it for some
/// seconds. Two scenarios share a car when they have the same physics model, including payload,
/// ground and obstacles. Thread-safe.
class CarCache {
 public:
  /// Keeps the `capacity` most recently used models, and those still referenced elsewhere.
  explicit CarCache(std::size_t capacity = 64);

  /// Returns the car of LoadCar. Reads a car's file only the first time. InputError as LoadCar; the
  /// next call tries again.
  std::shared_ptr<const CarModel> Load(const Scenario& scenario);

  /// Number of models compiled so far, including those no longer kept. A car with a payload or in a
  /// world counts as a separate model from the bare car.
  [[nodiscard]] std::size_t compiled() const;

 private:
  using Car = std::shared_ptr<const CarModel>;
  struct Slot {
    std::shared_future<Car> car;
    std::size_t last_use = 0;
  };

  /// The car of that key, compiled by the first thread that asks for it.
  Car Find(const std::string& key, const std::function<CarModel()>& compile);
  void ForgetOldest();

  std::size_t capacity_;
  mutable std::mutex mutex_;  // guards the members below
  std::unordered_map<std::string, Slot> slots_;
  std::size_t uses_ = 0;
  std::size_t compiled_ = 0;
};

}  // namespace trackbed
