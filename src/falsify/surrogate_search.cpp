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
      // Use the highest known value for a point whose run has no objective, because dlib proposes a
      // point repeatedly until it receives a value.
      const double value = values[i].value_or(highest_);
      Keep(batch_[i], value);
      // Construct a new dlib search if a value has changed, or if dlib did not request the point.
      // dlib accepts changed or unrequested values only in the constructor of a search.
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
  // dlib alternates between exploring and refining, so a batch of two points contains one exploring
  // point and one refining point.
  static constexpr int kBatch = 2;
  // Noise of the objective that dlib assumes, relative to the range of the objective's values;
  // 0.001 is dlib's default.
  static constexpr double kNoise = 0.001;

  void Keep(const UnitPoint& point, double value) {
    known_[point] = value;
    highest_ = known_.size() == 1 ? value : std::max(highest_, value);
    if (value < 0.0) {
      violations_.push_back(point);
    }
  }

  /// Returns the value that is passed to dlib for a known point. If the search continues after a
  /// violation, the objective values near known violations are raised. The search then finds
  /// violations in other regions (similar to deflation in root finding).
  [[nodiscard]] double ObjectiveAt(const UnitPoint& point) const {
    const double value = known_.at(point);
    if (spec_.stop || violations_.empty()) {
      return value;
    }
    // Distance from a violation within which objective values are clearly raised, as a fraction of
    // a key's range.
    constexpr double kRepulsionRadius = 0.15;
    double nearest = std::numeric_limits<double>::infinity();
    for (const UnitPoint& violation : violations_) {
      nearest = std::min(nearest, Distance(point, violation) / kRepulsionRadius);
    }
    return std::max(value, 0.0) + height_ * std::exp(-0.5 * nearest * nearest);
  }

  /// Returns by how much the objective at a violation is raised: three times the median of the
  /// objective at passing points.
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

  /// Asks dlib for a new point. A proposal, rounded to the steps of the keys, may be a known point.
  /// For a known point, Propose passes the known value to dlib and asks for another point.
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

  /// Returns the point of a sample that is farthest from all known points, or nullopt if all sample
  /// points are known.
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
  // Objective values of the known points. The coordinates of a point are rounded to the steps of
  // the keys.
  std::map<UnitPoint, double> known_;
  double highest_ = 0.0;  // Highest known objective value.
  std::vector<UnitPoint> violations_;
  double height_ = 0.0;  // amount by which the objective at a violation is raised
  dlib::global_function_search search_{UnitCube(1)};
  // Requests that dlib made for the points of the current batch.
  std::map<UnitPoint, dlib::function_evaluation_request> requests_;
  std::vector<UnitPoint> batch_;
  int proposals_ = 0;
};

}  // namespace

std::unique_ptr<PointSearch> MakeSurrogateSearch(const SearchSpec& spec, const SearchSpace& space,
                                                 std::optional<double> at_nominal) {
  return std::make_unique<SurrogateSearch>(spec, space, at_nominal);
}

}  // namespace trackbed
