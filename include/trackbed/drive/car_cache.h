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

/// Compiled cars that scenarios share: compiling one takes as long as some seconds of driving it.
/// Two scenarios share a car when they make the same physics model of it, payload, ground and
/// obstacles included. Safe to use from several threads at once.
class CarCache {
 public:
  /// Keeps the `most` models used last, besides those that somebody holds.
  explicit CarCache(std::size_t most = 64);

  /// The car that LoadCar gives. A car's file is read the first time only. InputError as LoadCar;
  /// the next call tries again.
  std::shared_ptr<const CarModel> Load(const Scenario& scenario);

  /// Models compiled so far, those that are no longer kept included. A car with a payload or in a
  /// world is a model besides the bare car.
  [[nodiscard]] std::size_t compiled() const;

 private:
  using Car = std::shared_ptr<const CarModel>;
  struct Slot {
    std::shared_future<Car> car;
    std::size_t last_use = 0;
  };

  /// The car of that key, compiled by the first who asks for it.
  Car Find(const std::string& key, const std::function<CarModel()>& compile);
  void ForgetOldest();

  std::size_t most_;
  mutable std::mutex mutex_;  // of what follows
  std::unordered_map<std::string, Slot> slots_;
  std::size_t uses_ = 0;
  std::size_t compiled_ = 0;
};

}  // namespace trackbed
