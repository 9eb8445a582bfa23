#include "src/falsify/point_search.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#include "src/falsify/surrogate_search.h"
#include "trackbed/core/error.h"
#include "trackbed/optimize/search.h"
#include "trackbed/scenario/sampling.h"

namespace trackbed {
namespace {

/// A search that proposes the points of a fixed sample and ignores the values of the objective.
class SampledPoints : public PointSearch {
 public:
  SampledPoints(const SampleSpec& spec, const SearchSpace& space)
      : space_(space), points_(UnitSample(spec, static_cast<int>(space.keys().size()))) {}

  std::vector<UnitPoint> Ask() override {
    constexpr Eigen::Index kBatch = 8;
    std::vector<UnitPoint> batch;
    for (; next_ < points_.rows() && static_cast<Eigen::Index>(batch.size()) < kBatch; ++next_) {
      UnitPoint point;
      for (Eigen::Index column = 0; column < points_.cols(); ++column) {
        point.push_back(
            space_.PlaceOfShare(static_cast<std::size_t>(column), points_(next_, column)));
      }
      batch.push_back(std::move(point));
    }
    return batch;
  }

  void Tell(const std::vector<std::optional<double>>& /*values*/) override {}

 private:
  const SearchSpace& space_;
  Eigen::MatrixXd points_;
  Eigen::Index next_ = 0;
};

SearchMethod NloptMethod(const std::string& name) {
  for (const SearchEntry& entry : Searches()) {
    if (name == entry.name) {
      return entry.method;
    }
  }
  throw InternalError("no search of this name: " + name);
}

/// Runs several NLopt searches in parallel. An NLopt search requests the values of points one after
/// the other, so each search runs in a separate thread. A batch contains one point of each
/// unfinished search.
class NloptSearches : public PointSearch {
 public:
  NloptSearches(const SearchSpec& spec, const SearchSpace& space, int restarts)
      : spec_(spec), space_(space), lanes_(static_cast<std::size_t>(restarts)) {
    const bool finishes = spec.finish != "none";
    const int last = finishes ? spec.runs / 4 : 0;
    // The first NLopt search starts at the nominal point; all other searches start at points of a
    // sample.
    const Eigen::MatrixXd starts =
        UnitSample({.count = restarts, .method = SampleMethod::kSobol, .seed = spec.seed},
                   static_cast<int>(space.keys().size()));
    const auto share = [&](int runs, int i) {
      return runs / restarts + (i < runs % restarts ? 1 : 0);
    };
    for (int i = 0; i < restarts; ++i) {
      Lane& lane = lanes_[static_cast<std::size_t>(i)];
      lane.start = space.nominal();
      for (std::size_t k = 0; i > 0 && k < lane.start.size(); ++k) {
        lane.start[k] = starts(i, static_cast<Eigen::Index>(k));
      }
      const int first_runs = share(spec.runs - last, i);
      const int last_runs = share(last, i);
      lane.thread = std::thread([this, &lane, i, first_runs, last_runs] {
        RunLane(lane, static_cast<std::uint64_t>(i), first_runs, last_runs);
      });
    }
  }

  ~NloptSearches() override {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    for (Lane& lane : lanes_) {
      lane.thread.join();
    }
  }

  std::vector<UnitPoint> Ask() override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] {
      return std::all_of(lanes_.begin(), lanes_.end(),
                         [](const Lane& lane) { return lane.state != State::kRuns; });
    });
    std::vector<UnitPoint> batch;
    for (const Lane& lane : lanes_) {
      if (lane.failure) {
        std::rethrow_exception(lane.failure);
      }
      if (lane.state == State::kAsks) {
        batch.push_back(lane.point);
      }
    }
    return batch;
  }

  void Tell(const std::vector<std::optional<double>>& values) override {
    {
      const std::lock_guard lock(mutex_);
      auto value = values.begin();
      for (Lane& lane : lanes_) {
        if (lane.state == State::kAsks) {
          lane.value = value++->value_or(std::numeric_limits<double>::quiet_NaN());
          lane.state = State::kRuns;
        }
      }
    }
    changed_.notify_all();
  }

 private:
  enum class State { kRuns, kAsks, kEnded };
  struct Stopped {};

  struct Lane {
    UnitPoint start;
    State state = State::kRuns;
    UnitPoint point;     // Point for which the NLopt search requests a value.
    double value = 0.0;  // Value of the minimized objective at `point`.
    std::exception_ptr failure;
    std::thread thread;
  };

  double ValueAt(Lane& lane, UnitPoint point) {
    std::unique_lock lock(mutex_);
    if (stopped_) {
      throw Stopped();
    }
    lane.point = std::move(point);
    lane.state = State::kAsks;
    changed_.notify_all();
    changed_.wait(lock, [&] { return stopped_ || lane.state == State::kRuns; });
    if (stopped_) {
      throw Stopped();
    }
    return lane.value;
  }

  SearchResult SearchFrom(Lane& lane, SearchMethod method, const UnitPoint& start, int evaluations,
                          std::uint64_t seed) {
    const std::size_t n = space_.keys().size();
    const SearchProblem problem{.lower = UnitPoint(n, 0.0),
                                .upper = UnitPoint(n, 1.0),
                                .start = start,
                                .objective =
                                    [&](std::span<const double> x) {
                                      return ValueAt(lane, space_.Snap({x.begin(), x.end()}));
                                    },
                                .constraint_count = 0,
                                .constraints = {}};
    const int population = static_cast<int>(4 * n + 4);
    return Search(problem,
                  {.method = method,
                   .population = spec_.population > 0 ? spec_.population : population,
                   .evaluations = evaluations,
                   .tolerance = 0.1 * spec_.tolerance},
                  seed);
  }

  [[nodiscard]] UnitPoint AnyPoint(std::uint64_t seed) const {
    const Eigen::MatrixXd point =
        UnitSample({.count = 1, .method = SampleMethod::kRandom, .seed = seed},
                   static_cast<int>(space_.keys().size()));
    return {point.data(), point.data() + point.size()};
  }

  void RunLane(Lane& lane, std::uint64_t number, int first_runs, int last_runs) {
    try {
      const SearchMethod method = NloptMethod(spec_.method);
      // Difference between the random seeds of consecutive restarts of a search.
      constexpr std::uint64_t kSeedStride = 1000003;
      SearchResult best;
      for (std::uint64_t again = 0; first_runs > 0; ++again) {
        const std::uint64_t seed = spec_.seed + number + kSeedStride * again;
        const SearchResult found =
            SearchFrom(lane, method, again == 0 ? lane.start : AnyPoint(seed), first_runs, seed);
        first_runs -= std::max(1, found.evaluations);
        if (!best.ok() || (found.ok() && found.value < best.value)) {
          best = found;
        }
        if (method == SearchMethod::kDirect) {
          break;  // a repetition of the deterministic method DIRECT would find the same point
        }
      }
      if (last_runs > 0 && best.ok()) {
        SearchFrom(lane, NloptMethod(spec_.finish), best.x, last_runs, spec_.seed);
      }
    } catch (const Stopped&) {
      // End the thread of the NLopt search, because the caller stopped the search.
    } catch (...) {
      lane.failure = std::current_exception();
    }
    {
      const std::lock_guard lock(mutex_);
      lane.state = State::kEnded;
    }
    changed_.notify_all();
  }

  const SearchSpec& spec_;
  const SearchSpace& space_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopped_ = false;
  std::vector<Lane> lanes_;
};

}  // namespace

std::unique_ptr<PointSearch> MakePointSearch(const SearchSpec& spec, const SearchSpace& space,
                                             std::optional<double> at_nominal) {
  if (spec.method == "surrogate") {
    return MakeSurrogateSearch(spec, space, at_nominal);
  }
  for (const SampleMethod method :
       {SampleMethod::kRandom, SampleMethod::kLatinHypercube, SampleMethod::kSobol}) {
    if (spec.method == ToString(method)) {
      return std::make_unique<SampledPoints>(
          SampleSpec{.count = spec.runs, .method = method, .seed = spec.seed}, space);
    }
  }
  const int restarts = spec.restarts > 0 ? spec.restarts : spec.method == "direct" ? 1 : 2;
  return std::make_unique<NloptSearches>(spec, space, std::min(restarts, spec.runs));
}

}  // namespace trackbed
