#include "trackbed/options/number_visitor.h"

#include <fmt/format.h>

namespace trackbed {

void NumberVisitor::Field(const Key& key, double& value, Need, Range range) {
  Number(key, value, range);
}

void NumberVisitor::Field(const Key& key, std::optional<double>& value, Range range) {
  if (value) {
    Number(key, *value, range);
  }
}

void NumberVisitor::Field(const Key& key, int& value, Need, Range range) {
  double number = value;
  Number(key, number, range);
}

void NumberVisitor::Field(const Key& key, std::vector<Vec2>& value, Need, const PairShape& shape) {
  Pairs(key, value, shape);
}

void NumberVisitor::Field(const Key& key, std::vector<double>& value, Need, Range range) {
  for (double& number : value) {
    Number(key, number, range);
  }
}

void NumberVisitor::Pair(const Key& key, int& first, int& second, Range range) {
  for (const int whole : {first, second}) {
    double number = whole;
    Number(key, number, range);
  }
}

void NumberVisitor::Within(const std::string& key, const Inside& inside) {
  const std::string outside = place_;
  place_ += (place_.empty() ? "" : ".") + key;
  inside(*this);
  place_ = outside;
}

bool NumberVisitor::VisitSection(const Key& key, Need, bool present, const Inside& inside) {
  if (present) {
    Within(key.name, inside);
  }
  return present;
}

void NumberVisitor::VisitList(const Key& key, std::size_t size,
                              const std::function<void(std::size_t)>&,
                              const std::function<void(KeyVisitor&, std::size_t)>& visit) {
  for (std::size_t i = 0; i < size; ++i) {
    Within(fmt::format("{}[{}]", key.name, i), [&](KeyVisitor& keys) { visit(keys, i); });
  }
}

void NumberVisitor::VisitMethod(const Key& key, Need, const Methods& methods) {
  if (methods.selected) {
    Within(key.name, methods.visit_selected);
    Within(key.name, methods.rest);
  }
}

}  // namespace trackbed
