#include "src/falsify/surrogate_search.h"

#include <dlib/global_optimization.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "trackbed/scenario/sampling.h"

namespace trackbed {
namespace {

using Vector = dlib::matrix<double, 0, 1>;

Vector VectorOf(const UnitPoint& point) {
  Vector x(static_cast<long>(point.size()));
  std::copy(point.begin(), point.end(), x.begin());
  return x;
}

dlib::function_spec UnitCube(std::size_t dimensions) {
  return {VectorOf(UnitPoint(dimensions, 0.0)), VectorOf(UnitPoint(dimensions, 1.0))};
}

class SurrogateSearch : public PointSearch {
 public:
  SurrogateSearch(const SearchSpec& spec, const SearchSpace& space,
                  std::optional<double> at_nominal)
      : spec_(spec), space_(space) {
    if (at_nominal) {
      Keep(space.nominal(), *at_nominal);
    }
    Restart();
  }

  std::vector<UnitPoint> Ask() override {
    std::vector<UnitPoint> batch;
    while (static_cast<int>(batch.size()) < kBatch && proposals_ < spec_.runs) {
      std::optional<UnitPoint> point = Propose(batch);
      if (!point) {
        point = FarthestPoint(batch);
      }
      if (!point) {
        break;
      }
      batch.push_back(*std::move(point));
      ++proposals_;
    }
    batch_ = batch;
    return batch;
  }

  void Tell(const std::vector<std::optional<double>>& values) override {
    bool restart = false;
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      // dlib proposes a point again until it gets a value. A point without a value therefore gets
      // the highest known value.
      const double value = values[i].value_or(highest_);
      Keep(batch_[i], value);
      // dlib accepts changed values, or values that it has not asked for, only in its constructor.
      // The search of dlib is therefore constructed again.
      restart =
          restart || requests_.find(batch_[i]) == requests_.end() || (value < 0.0 && !spec_.stop);
    }
    if (restart) {
      requests_.clear();
      Restart();
      return;
    }
    for (auto& [point, request] : requests_) {
      request.set(-ObjectiveAt(point));
    }
    requests_.clear();
  }

 private:
  // dlib alternates between exploring and refining, so a batch of two has one point of each.
  static constexpr int kBatch = 2;
  // Noise relative to the range of the values; the default of dlib.
  static constexpr double kNoise = 0.001;

  void Keep(const UnitPoint& point, double value) {
    known_[point] = value;
    highest_ = known_.size() == 1 ? value : std::max(highest_, value);
    if (value < 0.0) {
      violations_.push_back(point);
    }
  }

  /// Objective at a point whose run is known. If the search continues after a violation, it should
  /// find other regions. The values near violations are therefore raised, as in deflation for roots
  /// of equations.
  [[nodiscard]] double ObjectiveAt(const UnitPoint& point) const {
    const double value = known_.at(point);
    if (spec_.stop || violations_.empty()) {
      return value;
    }
    constexpr double kRepulsionRadius = 0.15;  // radius around a violation, relative to the range
                                               // of a key
    double nearest = std::numeric_limits<double>::infinity();
    for (const UnitPoint& violation : violations_) {
      nearest = std::min(nearest, Distance(point, violation) / kRepulsionRadius);
    }
    return std::max(value, 0.0) + height_ * std::exp(-0.5 * nearest * nearest);
  }

  /// Amount by which values are raised at a violation: three times the median of the passing
  /// values.
  [[nodiscard]] double Height() const {
    std::vector<double> values;
    for (const auto& [point, value] : known_) {
      if (value >= 0.0) {
        values.push_back(value);
      }
    }
    if (values.empty()) {
      return 1.0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return 3.0 * *middle;
  }

  void Restart() {
    height_ = Height();
    std::vector<dlib::function_evaluation> evaluations;
    for (const auto& [point, value] : known_) {
      evaluations.emplace_back(VectorOf(point), -ObjectiveAt(point));
    }
    search_ = dlib::global_function_search(
        {UnitCube(space_.keys().size())},
        std::vector<std::vector<dlib::function_evaluation>>{std::move(evaluations)}, kNoise);
    search_.set_seed(static_cast<time_t>(spec_.seed + known_.size()));
  }

  /// Asks dlib for a new point. dlib ignores steps and may propose known points again; such points
  /// get their known value.
  std::optional<UnitPoint> Propose(const std::vector<UnitPoint>& batch) {
    constexpr int kMaxAttempts = 20;
    for (int i = 0; i < kMaxAttempts; ++i) {
      dlib::function_evaluation_request request = search_.get_next_x();
      const Vector& x = request.x();
      UnitPoint point = space_.Snap({x.begin(), x.end()});
      const auto known = known_.find(point);
      if (known != known_.end()) {
        request.set(-ObjectiveAt(point));
      } else if (std::find(batch.begin(), batch.end(), point) == batch.end()) {
        requests_.insert_or_assign(point, std::move(request));
        return point;
      }
    }
    return std::nullopt;
  }

  /// The point of a sample that is farthest from all known points; none if all points are known.
  std::optional<UnitPoint> FarthestPoint(const std::vector<UnitPoint>& batch) {
    const Eigen::MatrixXd sample = UnitSample(
        {.count = 1024, .method = SampleMethod::kSobol, .seed = spec_.seed + known_.size()},
        static_cast<int>(space_.keys().size()));
    std::optional<UnitPoint> best;
    double farthest = 0.0;
    for (Eigen::Index row = 0; row < sample.rows(); ++row) {
      UnitPoint point(static_cast<std::size_t>(sample.cols()));
      for (std::size_t i = 0; i < point.size(); ++i) {
        point[i] = sample(row, static_cast<Eigen::Index>(i));
      }
      point = space_.Snap(point);
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& [known, value] : known_) {
        nearest = std::min(nearest, Distance(point, known));
      }
      for (const UnitPoint& other : batch) {
        nearest = std::min(nearest, Distance(point, other));
      }
      if (nearest > farthest) {
        farthest = nearest;
        best = std::move(point);
      }
    }
    return best;
  }

  const SearchSpec& spec_;
  const SearchSpace& space_;
  std::map<UnitPoint, double> known_;  // Objective of each known point, rounded to the steps.
  double highest_ = 0.0;               // Highest known objective.
  std::vector<UnitPoint> violations_;
  double height_ = 0.0;  // amount by which values near violations are raised
  dlib::global_function_search search_{UnitCube(1)};
  std::map<UnitPoint, dlib::function_evaluation_request> requests_;  // dlib's requests for the
                                                                     // current batch
  std::vector<UnitPoint> batch_;
  int proposals_ = 0;
};

}  // namespace

std::unique_ptr<PointSearch> MakeSurrogateSearch(const SearchSpec& spec, const SearchSpace& space,
                                                 std::optional<double> at_nominal) {
  return std::make_unique<SurrogateSearch>(spec, space, at_nominal);
}

}  // namespace trackbed
