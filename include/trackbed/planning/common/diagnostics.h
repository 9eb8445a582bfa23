#pragma once

#include <any>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/path/path.h"

/// Typed diagnostics of planners, independent of any file format.
///
/// The diagnostics of a planner can be any copyable struct. A function `Visit`, found by
/// argument-dependent lookup, names the fields of the struct:
///
///     void Visit(DiagnosticsVisitor& out, const MyDiagnostics& own) {
///       out.Integer("expansions", own.expansions);
///       out.Number("cost_m", own.cost);
///     }
///
/// The writer of plan.json and the printer of `trackbed plan` are visitors. The name of a field
/// ends with its unit, as the names of table columns do, for example "cost_m".
namespace trackbed {

class DiagnosticsVisitor {
 public:
  virtual ~DiagnosticsVisitor() = default;

  /// Returns whether the visitor wants all fields, as for plan.json. For other visitors, `Visit`
  /// should visit only a summary, without points, histories and values derived from other fields.
  [[nodiscard]] virtual bool full() const = 0;

  /// Visits a number. A number that is not finite becomes null in plan.json.
  virtual void Number(const char* name, double value) = 0;
  virtual void Integer(const char* name, std::int64_t value) = 0;
  virtual void Flag(const char* name, bool value) = 0;
  virtual void Text(const char* name, const std::string& value) = 0;
  virtual void Numbers(const char* name, const std::vector<double>& values) = 0;
  virtual void Point(const char* name, const Vec2& value) = 0;
  virtual void Points(const char* name, const std::vector<Vec2>& values) = 0;

  template <std::integral Count>
  void Integer(const char* name, Count value) {
    Integer(name, static_cast<std::int64_t>(value));
  }

  /// Visits the fields of a nested struct under `name`.
  template <typename Struct>
  void Section(const char* name, const Struct& value) {
    VisitSection(name, [&](DiagnosticsVisitor& inner) { Visit(inner, value); });
  }

  /// Visits a list of structs, which may be empty.
  template <typename Struct>
  void List(const char* name, const std::vector<Struct>& values) {
    VisitList(name, values.size(),
              [&](DiagnosticsVisitor& inner, std::size_t i) { Visit(inner, values[i]); });
  }

 protected:
  using Inside = std::function<void(DiagnosticsVisitor& inner)>;
  using Element = std::function<void(DiagnosticsVisitor& inner, std::size_t i)>;

  virtual void VisitSection(const char* name, const Inside& inside) = 0;
  virtual void VisitList(const char* name, std::size_t size, const Element& element) = 0;
};

/// Holds the diagnostics of one method: nothing, or any copyable struct that has a function
/// `Visit`.
///
/// A struct that contains stations of the path may also have the function
///
///     void ReplaceStretch(MyDiagnostics& own, const Stations& replaced, double shift);
///
/// When a stretch of the path is replaced, ReplaceStretch shifts the struct's stations beyond that
/// stretch by `shift` [m].
class MethodDiagnostics {
 public:
  MethodDiagnostics() = default;

  template <typename Struct>
  requires(!std::is_same_v<std::decay_t<Struct>, MethodDiagnostics>) MethodDiagnostics(
      Struct own)  // NOLINT(google-explicit-constructor): the conversion is implicit by design
      : value_(std::move(own)), visit_([](DiagnosticsVisitor& out, const std::any& value) {
          Visit(out, *std::any_cast<Struct>(&value));
        }) {
    if constexpr (requires(Struct & value, const Stations& stations) {
                    ReplaceStretch(value, stations, 0.0);
                  }) {
      replace_ = [](std::any& value, const Stations& replaced, double shift) {
        ReplaceStretch(*std::any_cast<Struct>(&value), replaced, shift);
      };
    }
  }

  [[nodiscard]] bool has_value() const { return value_.has_value(); }

  /// Returns the contained diagnostics struct if its type is `Struct`; else null.
  template <typename Struct>
  [[nodiscard]] const Struct* GetIf() const {
    return std::any_cast<Struct>(&value_);
  }

  /// Returns the contained diagnostics struct. Throws InternalError if the type of the contained
  /// struct is not `Struct`.
  template <typename Struct>
  [[nodiscard]] const Struct& Get() const {
    TRACKBED_CHECK(GetIf<Struct>() != nullptr, "diagnostics of another method: {}",
                   value_.type().name());
    return *GetIf<Struct>();
  }

  /// Visits the fields of the contained struct, if there is one.
  friend void Visit(DiagnosticsVisitor& out, const MethodDiagnostics& own) {
    if (own.visit_ != nullptr) {
      own.visit_(out, own.value_);
    }
  }

  friend void ReplaceStretch(MethodDiagnostics& own, const Stations& replaced, double shift) {
    if (own.replace_ != nullptr) {
      own.replace_(own.value_, replaced, shift);
    }
  }

 private:
  std::any value_;
  void (*visit_)(DiagnosticsVisitor& out, const std::any& value) = nullptr;
  void (*replace_)(std::any& value, const Stations& replaced, double shift) = nullptr;
};

}  // namespace trackbed
