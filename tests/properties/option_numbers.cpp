#include "tests/properties/option_numbers.h"

#include <optional>
#include <vector>

namespace properties {
namespace {

using namespace trackbed;

using Call = std::function<void(const std::string& key, double& value, Range range)>;

class Numbers final : public KeyVisitor {
 public:
  explicit Numbers(const Call& call) : call_(call) {}

  [[nodiscard]] Mode mode() const override { return Mode::kWrite; }
  void Field(const Key& key, double& value, Need, Range range) override {
    call_(key.name, value, range);
  }
  void Field(const Key& key, std::optional<double>& value, Range range) override {
    double own = value.value_or(1.0);
    const double before = own;
    call_(key.name, own, range);
    if (value || !(own == before)) {
      value = own;
    }
  }
  void Field(const Key&, std::optional<bool>&) override {}
  void Field(const Key&, bool&, Need) override {}
  void Field(const Key&, int&, Need, Range) override {}
  void Field(const Key&, std::uint64_t&, Need) override {}
  void Field(const Key&, std::string&, Need, const Names&) override {}
  void Field(const Key&, std::optional<std::string>&) override {}
  void Field(const Key&, std::vector<std::string>&, Need, const Names&) override {}
  void Field(const Key&, std::vector<Vec2>&, Need, const PairShape&) override {}
  void Field(const Key& key, std::vector<double>& value, Need, Range range) override {
    for (double& number : value) {
      call_(key.name, number, range);
    }
  }
  void Identifier(const Key&, std::string&) override {}
  void Pair(const Key&, int&, int&, Range) override {}

 protected:
  bool VisitSection(const Key&, Need, bool present, const Inside& inside) override {
    if (present) {
      inside(*this);
    }
    return present;
  }
  void VisitList(const Key&, std::size_t size, const std::function<void(std::size_t)>&,
                 const std::function<void(KeyVisitor&, std::size_t)>& visit) override {
    for (std::size_t i = 0; i < size; ++i) {
      visit(*this, i);
    }
  }
  void VisitMethod(const Key&, Need, const Methods& methods) override {
    if (methods.selected) {
      methods.visit_selected(*this);
    }
  }

 private:
  const Call& call_;
};

}  // namespace

void ForEachNumber(const KeyVisitor::Inside& visit, const Call& call) {
  Numbers numbers(call);
  visit(numbers);
}

}  // namespace properties
