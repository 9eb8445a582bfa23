#include "trackbed/control/tyre_forces.h"

namespace trackbed {

void Visit(KeyVisitor& keys, TyreForces& forces) {
  static const EnumNames<TyreForces> names{
      {TyreForces::kNone, "none"}, {TyreForces::kLinear, "linear"}, {TyreForces::kBrush, "brush"}};
  keys.Field({"tyres", "",
              "tyres of the model: none, linear, or brush, which saturate, about the planned "
              "accelerations"},
             forces, Need::kOptional, names);
}

}  // namespace trackbed
