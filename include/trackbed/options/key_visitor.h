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

/// Declares the keys of an options struct. Reading, writing and listing use the same declaration.
///
/// Each options struct has a function
///
///     void Visit(KeyVisitor& keys, MyOptions& options) {
///       keys.Field({"distance", "m", "lookahead distance"}, options.distance,
///                  Need::kOptional, kPositive);
///     }
///
/// which is found by argument-dependent lookup. The reader of YAML files, the writer of resolved
/// scenarios and the lister of `trackbed docs` are visitors.
namespace trackbed {

/// A key and its description in the docs.
struct Key {
  const char* name;
  const char* unit;  ///< Unit, such as "m/s"; empty for keys that are not quantities.
  const char* text;  ///< One-line description for users.
};

/// The key that selects one of several methods, each with separate keys.
inline constexpr Key kMethod{"method", "", "name of the method; each has its own keys"};

enum class Need { kRequired, kOptional };

/// Allowed values of a number. `above` is exclusive, `min` and `max` are inclusive. If a bound is
/// missing, readers set a bound that depends on the unit (WithinReason).
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();
  /// Whether the number is a direction [rad], which readers wrap to (-pi, pi].
  bool is_direction = false;
};

inline constexpr Range kPositive{.above = 0.0};
inline constexpr Range kNonNegative{.min = 0.0};

inline constexpr Range kDirection{.is_direction = true};       ///< Direction [rad].
inline constexpr Range kMap{.min = -1e5, .max = 1e5};          ///< Map position [m].
inline constexpr Range kSpeedRange{.min = 0.0, .max = 100.0};  ///< Speed [m/s].
inline constexpr Range kSteering{.min = -1.5, .max = 1.5};     ///< Steering angle [rad].

/// Describes a list of pairs of numbers: the names of one pair and of several pairs, and the
/// allowed values.
struct PairShape {
  const char* one;
  const char* many;
  Range first;
  Range second;
};

inline constexpr PairShape kPoint{"a point [x, y]", "points [x, y]", kMap, kMap};

/// Returns the range with its missing bounds filled in. A missing bound depends on the key's unit
/// and lies beyond any realistic value: 1e5 m, 1e6 s or 1e3 m/s, for example, and 1e12 for other
/// units.
Range WithinReason(const Key& key, Range range);

/// Formats the allowed values as text: "above 0 and at most 10"; empty if all values are allowed.
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
  /// A required name that can be a file name: letters, digits, '_', '-', '.', not starting with
  /// '.'.
  virtual void Identifier(const Key& key, std::string& value) = 0;
  /// A list of two whole numbers.
  virtual void Pair(const Key& key, int& first, int& second, Range range) = 0;

  /// The value of an enumeration, which has a name for each value.
  template <typename Enum>
  void Field(const Key& key, Enum& value, Need need,
             const EnumNames<Enum>& names) requires std::is_enum_v<Enum>;

  /// A section with the keys of a struct.
  template <typename Struct>
  void Section(const Key& key, Struct& value, Need need = Need::kOptional) {
    VisitSection(key, need, true, [&](KeyVisitor& inner) { Visit(inner, value); });
  }

  /// An optional section. The program distinguishes an absent section from an empty one.
  template <typename Struct>
  void Section(const Key& key, std::optional<Struct>& value);

  /// A list of sections with the keys of a struct.
  template <typename Struct>
  void List(const Key& key, std::vector<Struct>& values);

  /// A section whose key `method` selects an entry of `table` by its `name`. The section has the
  /// keys of the entry's options (`defaults`), and the keys of `rest`, which are the same for all
  /// methods.
  template <typename Options, typename Entry>
  void Method(const Key& key, std::optional<Options>& value, const std::vector<Entry>& table,
              Need need, const Inside& rest = {});

  /// Lists a key that is described only by its text; does nothing in modes other than kList.
  virtual void Mention(const Key&, const char* /*type*/) {}

  /// In mode kRead, whether `key` is a section that has a key of `inner` but no key `method`.
  [[nodiscard]] virtual bool HasAny(const char* /*key*/, const Names& /*inner*/) const {
    return false;
  }

 protected:
  /// The methods that a section can select, without the types of their options.
  struct Methods {
    struct Entry {
      const char* name;
      const char* summary;
    };
    std::vector<Entry> entries;
    std::optional<std::size_t> selected;
    /// Selects an entry, with the entry's defaults.
    std::function<void(std::size_t entry)> select;
    Inside visit_selected;
    std::function<void(std::size_t entry, KeyVisitor& keys)> visit_defaults;
    Inside rest;
  };

  /// Visits the keys of a section if the section exists, and returns whether it exists. For the
  /// writer, the section exists if `present` is true; for the reader, if the file has the section.
  virtual bool VisitSection(const Key& key, Need need, bool present, const Inside& inside) = 0;
  /// Visits each element of a list. The reader first resizes the list. The lister visits the
  /// element at index `size`, which represents a new element.
  virtual void VisitList(const Key& key, std::size_t size,
                         const std::function<void(std::size_t size)>& resize,
                         const std::function<void(KeyVisitor& keys, std::size_t i)>& visit) = 0;
  virtual void VisitMethod(const Key& key, Need need, const Methods& methods) = 0;
};

/// Returns the number at `key` among the keys that `visit` declares; nullopt if there is no such
/// key.
std::optional<double> FindNumber(const std::string& key, const KeyVisitor::Inside& visit);

/// PreconditionError unless every number among the keys is finite and within its key's range; the
/// message names `owner`, the called function, and the key. Use RequireInRange for options that a
/// program set; options read from files have already been checked.
void RequireInRange(const std::string& owner, const KeyVisitor::Inside& visit);

/// For variants of options, AreOfOneMethod tells whether two options belong to the same method, and
/// Visit visits the keys of the options. The class MethodOptions has functions of the same names
/// (method_options.h).
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
