#include "render/skid_marks.h"

#include <map>
#include <optional>

#include "render/ground_line.h"
#include "render/tyre_forces.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed::render {
namespace {

constexpr double kSkidWidth = 0.17;  // Width of a skid mark, about that of a tyre [m].
// Height of a skid mark above the ground, below plans and trails [m].
constexpr double kSkidHeight = 0.003;
constexpr double kMinSkidLength = 0.15;  // Minimum length of a piece of a skid mark [m].
constexpr Color kRubber{0.10F, 0.10F, 0.11F};

class SkidMarks : public Overlay {
 public:
  explicit SkidMarks(const OverlaySetup& setup) : recording_(setup.recording) {
    const TyreForces forces(recording_);
    if (!forces.known()) {
      return;
    }
    const MujocoData data = MakeMujocoData(*recording_.model);
    const PlantRecording& car = recording_.plants.front();
    std::map<int, Point> begins;  // for each wheel, the point at which its present skid mark starts
    for (const double time : car.times()) {
      car.Pose(time, *recording_.model, *data);
      std::map<int, Point> still;
      for (const WheelForce& wheel : forces.At(time, *data)) {
        if (wheel.Use() <= kSkidUse) {
          continue;
        }
        const Point here{wheel.place.x(), wheel.place.y(), wheel.place.z()};
        const auto begin = begins.find(wheel.body);
        if (begin == begins.end()) {
          still.emplace(wheel.body, here);
        } else if (std::hypot(here.x - begin->second.x, here.y - begin->second.y) <
                   scale_ * kMinSkidLength) {
          still.insert(*begin);
        } else {
          pieces_.push_back({time, begin->second, here});
          still.emplace(wheel.body, here);
        }
      }
      begins = std::move(still);
    }
  }

  [[nodiscard]] std::size_t max_shapes() const override { return pieces_.size(); }

  void AddShapes(SceneContext& context) override {
    for (const Piece& piece : pieces_) {
      if (piece.time > context.time) {
        break;
      }
      AddPiece(context, recording_.world, piece.from, piece.to,
               {kRubber, scale_ * kSkidWidth, kSkidHeight});
    }
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    if (!pieces_.empty()) {
      legend.push_back({kRubber, "skid mark: over 90 % of grip"});
    }
  }

 private:
  struct Piece {
    double time;  // time at which the tyre reaches the end of this piece of a skid mark [s]
    Point from;
    Point to;
  };

  const Recording& recording_;
  double scale_ = FindCarBox(*recording_.model).scale();
  std::vector<Piece> pieces_;  // pieces of skid marks, in the order of time
};

}  // namespace

OverlayEntry SkidMarkOverlay() {
  return MakeOverlayEntry<SkidMarks>("skid", "marks of tyres that use more than 0.9 of their grip");
}

}  // namespace trackbed::render
