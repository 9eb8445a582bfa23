#include "src/sim/adapt_faults.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "src/sim/object_name.h"

namespace trackbed::adapt {
namespace {

/// Returns the index of the wheel with which the body turns; -1 if the body does not turn with a
/// wheel.
int WheelOf(const mjModel& m, const FoundVehicle& vehicle, int body) {
  for (std::size_t w = 0; w < vehicle.wheels.size(); ++w) {
    if (m.body_weldid[body] == m.body_weldid[vehicle.wheels[w].body]) {
      return static_cast<int>(w);
    }
  }
  return -1;
}

/// Adds a note that names the joints by which the base body moves, if none of them is a free joint.
void NoteBase(const FoundModel& found, const FoundVehicle& vehicle, Findings& findings) {
  const mjModel& m = *found.model;
  std::vector<int> bodies;
  for (int body = vehicle.base; body > 0; body = m.body_parentid[body]) {
    bodies.insert(bodies.begin(), body);
  }
  std::vector<std::string> joints;
  for (const int body : bodies) {
    for (int joint = m.body_jntadr[body]; joint < m.body_jntadr[body] + m.body_jntnum[body];
         ++joint) {
      if (m.jnt_type[joint] == mjJNT_FREE) {
        return;
      }
      const char* kind = m.jnt_type[joint] == mjJNT_SLIDE   ? "slide"
                         : m.jnt_type[joint] == mjJNT_HINGE ? "hinge"
                                                            : "ball";
      joints.push_back(fmt::format("{} {}", kind, ObjectName(m, mjOBJ_JOINT, joint)));
    }
  }
  if (joints.empty()) {
    if (!found.is_urdf) {
      findings.notes.emplace_back("the vehicle is fixed to the world; it gets a free joint");
    }
  } else {
    findings.notes.push_back(
        fmt::format("the base moves by the joints {} instead of a free joint; its tyres would "
                    "carry no load. It gets a free joint",
                    fmt::join(joints, ", ")));
  }
}

/// Adds a note for each contact of a tyre with the vehicle that is not yet in `known`, in the
/// present configuration of `data`.
void NoteRubbing(const FoundModel& found, const FoundVehicle& vehicle, const mjData& data,
                 const char* when, std::set<std::pair<int, int>>& known, Findings& findings) {
  const mjModel& m = *found.model;
  for (int i = 0; i < data.ncon; ++i) {
    const int a = data.contact[i].geom1;
    const int b = data.contact[i].geom2;
    if (a < 0 || b < 0) {
      continue;
    }
    const int first = WheelOf(m, vehicle, m.geom_bodyid[a]);
    const int second = WheelOf(m, vehicle, m.geom_bodyid[b]);
    const bool own = m.body_rootid[m.geom_bodyid[a]] == vehicle.root &&
                     m.body_rootid[m.geom_bodyid[b]] == vehicle.root;
    if (!own || (first < 0 && second < 0) || first == second) {
      continue;
    }
    const int wheel = first >= 0 ? first : second;
    const int other = first >= 0 ? b : a;
    if (!known.emplace(wheel, other).second) {
      continue;
    }
    findings.notes.push_back(fmt::format(
        "the tyre of {} touches the geom {} of the body {} {}; only tyres "
        "collide in the proposed file",
        vehicle.wheels[static_cast<std::size_t>(wheel)].name, ObjectName(m, mjOBJ_GEOM, other),
        ObjectName(m, mjOBJ_BODY, m.geom_bodyid[other]), when));
  }
}

/// Adds a note for each equality constraint that acts on the joints of the steering.
void NoteEqualities(const FoundModel& found, const FoundVehicle& vehicle, Findings& findings) {
  const mjModel& m = *found.model;
  for (int i = 0; i < m.neq; ++i) {
    if (m.eq_type[i] != mjEQ_JOINT) {
      continue;
    }
    const auto is_of = [&](int joint) {
      return joint >= 0 &&
             std::any_of(vehicle.wheels.begin(), vehicle.wheels.end(),
                         [&](const FoundWheel& wheel) { return wheel.steer == joint; });
    };
    if (is_of(m.eq_obj1id[i]) || is_of(m.eq_obj2id[i])) {
      findings.notes.push_back(fmt::format(
          "the equality constraint {} between the joints {} and {} is replaced by Ackermann's "
          "linkage",
          ObjectName(m, mjOBJ_EQUALITY, i), ObjectName(m, mjOBJ_JOINT, m.eq_obj1id[i]),
          m.eq_obj2id[i] < 0 ? "none" : ObjectName(m, mjOBJ_JOINT, m.eq_obj2id[i])));
    }
  }
}

/// Adds a note for each joint of the vehicle that does not become a joint in the proposed file.
void NoteLocked(const FoundModel& found, const FoundVehicle& vehicle, Findings& findings) {
  const mjModel& m = *found.model;
  std::vector<std::string> locked;
  for (int joint = 0; joint < m.njnt; ++joint) {
    const int body = m.jnt_bodyid[joint];
    bool is_kept = m.body_rootid[body] != vehicle.root || m.jnt_type[joint] == mjJNT_FREE;
    for (int above = vehicle.base; above > 0; above = m.body_parentid[above]) {
      is_kept = is_kept || above == body;
    }
    for (const FoundWheel& wheel : vehicle.wheels) {
      is_kept = is_kept || joint == wheel.spin || joint == wheel.steer || joint == wheel.slide;
    }
    if (!is_kept) {
      locked.push_back(ObjectName(m, mjOBJ_JOINT, joint));
    }
  }
  if (!locked.empty()) {
    findings.notes.push_back(
        fmt::format("locked at their initial positions: the joints {}", fmt::join(locked, ", ")));
  }
}

}  // namespace

void NoteFaults(const FoundModel& found, const FoundVehicle& vehicle, Findings& findings) {
  NoteBase(found, vehicle, findings);
  NoteEqualities(found, vehicle, findings);
  NoteLocked(found, vehicle, findings);
  std::set<std::pair<int, int>> rubbing;  // pairs of a wheel and a geom that it touches
  NoteRubbing(found, vehicle, *found.data, "at rest", rubbing, findings);
  // Repeat the search for tyre contacts with the front wheels at both ends of their steering
  // ranges.
  const mjModel& m = *found.model;
  for (const int side : {0, 1}) {
    const MujocoData data = MakeMujocoData(m);
    bool steers = false;
    for (const FoundWheel& wheel : vehicle.wheels) {
      if (wheel.steer >= 0 && m.jnt_limited[wheel.steer] != 0) {
        data->qpos[m.jnt_qposadr[wheel.steer]] = m.jnt_range[2 * wheel.steer + side];
        steers = true;
      }
    }
    if (steers) {
      mj_kinematics(&m, data.get());
      mj_comPos(&m, data.get());
      mj_collision(&m, data.get());
      NoteRubbing(found, vehicle, *data, "at full lock", rubbing, findings);
    }
  }
}

}  // namespace trackbed::adapt
