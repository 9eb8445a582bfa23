#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "trackbed/geometry/pose.h"

/// Declares the keys of an options struct. The same declaration serves to read, write and list the
/// options.
///
/// Each options struct has a function
///
///     void Visit(KeyVisitor& keys, MyOptions& options) {
///       keys.Field({"distance", "m", "lookahead distance"}, options.distance,
///                  Need::kOptional, kPositive);
///     }
///
/// The compiler finds this function by argument-dependent lookup. Three visitors exist: one reads
/// YAML files, one writes resolved scenarios, and one lists the keys for `trackbed docs`.
namespace trackbed {

/// A key of an options struct, and the key's description in the documentation.
struct Key {
  const char* name;
  /// Unit of the key, such as "m/s"; empty if the key is not a physical quantity.
  const char* unit;
  const char* text;  ///< Description of the key for users, on one line.
};

/// A key that selects one of several methods; the other keys of the section depend on the method.
inline constexpr Key kMethod{"method", "", "name of the method; each has its own keys"};

enum class Need { kRequired, kOptional };

/// Allowed values of a number. `above` is exclusive, `min` and `max` are inclusive. For a missing
/// bound, the reader of YAML files uses a bound that depends on the key's unit (WithinReason).
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();
  /// Whether the number is an angle [rad]; the reader of YAML files then wraps the number to (-pi,
  /// pi].
  bool is_direction = false;
};

inline constexpr Range kPositive{.above = 0.0};
inline constexpr Range kNonNegative{.min = 0.0};

inline constexpr Range kDirection{.is_direction = true};       ///< Direction [rad].
inline constexpr Range kMap{.min = -1e5, .max = 1e5};          ///< Map position [m].
inline constexpr Range kSpeedRange{.min = 0.0, .max = 100.0};  ///< Speed [m/s].
inline constexpr Range kSteering{.min = -1.5, .max = 1.5};     ///< Steering angle [rad].

/// Describes a list of pairs of numbers: the word for one pair, the word for several pairs, and the
/// allowed values.
struct PairShape {
  const char* one;
  const char* many;
  Range first;
  Range second;
};

inline constexpr PairShape kPoint{"a point [x, y]", "points [x, y]", kMap, kMap};

/// Returns a key's range, with default values for missing bounds. The default for a missing bound
/// depends on the key's unit and lies beyond any realistic value. For example, a missing upper
/// bound of a key becomes 1e5 m, 1e6 s or 1e3 m/s, or 1e12 in other units. A missing lower bound
/// becomes the negative of the value for a missing upper bound.
Range WithinReason(const Key& key, Range range);

/// Formats the allowed values as text, such as "above 0 and at most 10"; returns an empty text if
/// all values are allowed.
std::string AllowedBy(Range range);

using Names = std::vector<std::string>;

template <typename Enum>
using EnumNames = std::vector<std::pair<Enum, const char*>>;

class KeyVisitor {
 public:
  enum class Mode { kRead, kWrite, kList };
  using Inside = std::function<void(KeyVisitor& keys)>;

  virtual ~KeyVisitor() = default;

  [[nodiscard]] virtual Mode mode() const = 0;

  virtual void Field(const Key& key, double& value, Need need, Range range = {}) = 0;
  virtual void Field(const Key& key, std::optional<double>& value, Range range = {}) = 0;
  virtual void Field(const Key& key, std::optional<bool>& value) = 0;
  virtual void Field(const Key& key, bool& value, Need need) = 0;
  virtual void Field(const Key& key, int& value, Need need, Range range = {}) = 0;
  virtual void Field(const Key& key, std::uint64_t& value, Need need) = 0;
  virtual void Field(const Key& key, std::string& value, Need need, const Names& allowed = {}) = 0;
  virtual void Field(const Key& key, std::optional<std::string>& value) = 0;
  virtual void Field(const Key& key, std::vector<std::string>& value, Need need,
                     const Names& allowed) = 0;
  virtual void Field(const Key& key, std::vector<Vec2>& value, Need need,
                     const PairShape& shape = kPoint) = 0;
  virtual void Field(const Key& key, std::vector<double>& value, Need need, Range range = {}) = 0;
  /// Visits a required name that can also serve as a file name: it has only letters, digits, '_',
  /// '-' and '.', and does not start with '.'.
  virtual void Identifier(const Key& key, std::string& value) = 0;
  /// Visits a list of two whole numbers.
  virtual void Pair(const Key& key, int& first, int& second, Range range) = 0;

  /// Visits a value of an enumeration, which is written by name.
  template <typename Enum>
  void Field(const Key& key, Enum& value, Need need,
             const EnumNames<Enum>& names) requires std::is_enum_v<Enum>;

  /// Visits a section that contains the keys of a struct.
  template <typename Struct>
  void Section(const Key& key, Struct& value, Need need = Need::kOptional) {
    VisitSection(key, need, true, [&](KeyVisitor& inner) { Visit(inner, value); });
  }

  /// Visits an optional section; a section that is absent is not the same as an empty section.
  template <typename Struct>
  void Section(const Key& key, std::optional<Struct>& value);

  /// Visits a list of sections that each contain the keys of a struct.
  template <typename Struct>
  void List(const Key& key, std::vector<Struct>& values);

  /// Visits a section whose key `method` selects the entry of `table` with that `name`. The section
  /// contains the keys of the entry's options (`defaults`), and the keys of `rest`, which are the
  /// same for all methods.
  template <typename Options, typename Entry>
  void Method(const Key& key, std::optional<Options>& value, const std::vector<Entry>& table,
              Need need, const Inside& rest = {});

  /// Adds a key to the list of keys; the key has only a description, and is not read or written.
  /// In modes other than kList, the key is not added.
  virtual void Mention(const Key&, const char* /*type*/) {}

  /// Returns true in mode kRead if the section `key` contains one of the keys `inner`, but no key
  /// `method`.
  [[nodiscard]] virtual bool HasAny(const char* /*key*/, const Names& /*inner*/) const {
    return false;
  }

 protected:
  /// The methods that a section can select, independent of the types of the methods' options.
  struct Methods {
    struct Entry {
      const char* name;
      const char* summary;
    };
    std::vector<Entry> entries;
    std::optional<std::size_t> selected;
    /// Selects a method's entry, and sets the options to the entry's defaults.
    std::function<void(std::size_t entry)> select;
    Inside visit_selected;
    std::function<void(std::size_t entry, KeyVisitor& keys)> visit_defaults;
    Inside rest;
  };

  /// Visits the keys of a section if the section exists. Returns whether the section exists. In
  /// mode kWrite, the section exists if `present` is true; in mode kRead, the section exists if the
  /// file has the section.
  virtual bool VisitSection(const Key& key, Need need, bool present, const Inside& inside) = 0;
  /// Visits each element of a list. In mode kRead, the list is first resized to the number of
  /// elements in the file. In mode kList, only the element at index `size` is visited; this element
  /// represents a new element.
  virtual void VisitList(const Key& key, std::size_t size,
                         const std::function<void(std::size_t size)>& resize,
                         const std::function<void(KeyVisitor& keys, std::size_t i)>& visit) = 0;
  virtual void VisitMethod(const Key& key, Need need, const Methods& methods) = 0;
};

/// Returns the number whose key is `key` among the keys that `visit` declares; nullopt if `visit`
/// declares no such key.
std::optional<double> FindNumber(const std::string& key, const KeyVisitor::Inside& visit);

/// Throws PreconditionError if the number of any key is not finite or is outside of the key's
/// range. The error message names the key and `owner`, the name of the called function. Use
/// RequireInRange for options that a program set; options read from files have already been
/// checked.
void RequireInRange(const std::string& owner, const KeyVisitor::Inside& visit);

/// Functions for options in a std::variant: AreOfOneMethod returns whether two options belong to
/// the same method, and Visit visits the keys of the options. The class MethodOptions has functions
/// with the same names AreOfOneMethod and Visit (method_options.h).
template <typename... Options>
bool AreOfOneMethod(const std::variant<Options...>& a, const std::variant<Options...>& b) {
  return a.index() == b.index();
}
template <typename... Options>
void Visit(KeyVisitor& keys, std::variant<Options...>& options) {
  std::visit([&](auto& own) { Visit(keys, own); }, options);
}

template <typename Enum>
void KeyVisitor::Field(const Key& key, Enum& value, Need need,
                       const EnumNames<Enum>& names) requires std::is_enum_v<Enum> {
  std::string name;
  Names allowed;
  for (const auto& [candidate, spelling] : names) {
    name = candidate == value ? spelling : name;
    allowed.emplace_back(spelling);
  }
  Field(key, name, need, allowed);
  for (const auto& [candidate, spelling] : names) {
    value = name == spelling ? candidate : value;
  }
}

template <typename Struct>
void KeyVisitor::Section(const Key& key, std::optional<Struct>& value) {
  Struct own = value.value_or(Struct{});
  if (VisitSection(key, Need::kOptional, value.has_value(),
                   [&](KeyVisitor& inner) { Visit(inner, own); })) {
    value = std::move(own);
  }
}

template <typename Struct>
void KeyVisitor::List(const Key& key, std::vector<Struct>& values) {
  VisitList(
      key, values.size(), [&](std::size_t size) { values.assign(size, Struct{}); },
      [&](KeyVisitor& inner, std::size_t i) {
        Struct added;
        Visit(inner, i < values.size() ? values[i] : added);
      });
}

template <typename Options, typename Entry>
void KeyVisitor::Method(const Key& key, std::optional<Options>& value,
                        const std::vector<Entry>& table, Need need, const Inside& rest) {
  Methods methods;
  for (std::size_t i = 0; i < table.size(); ++i) {
    methods.entries.push_back({table[i].name, table[i].summary});
    if (value && AreOfOneMethod(table[i].defaults, *value)) {
      methods.selected = i;
    }
  }
  methods.select = [&](std::size_t i) { value = table[i].defaults; };
  methods.visit_selected = [&](KeyVisitor& inner) { Visit(inner, *value); };
  methods.visit_defaults = [&](std::size_t i, KeyVisitor& inner) {
    Options defaults = table[i].defaults;
    Visit(inner, defaults);
  };
  methods.rest = rest ? rest : [](KeyVisitor&) {};
  VisitMethod(key, need, methods);
}

}  // namespace trackbed
