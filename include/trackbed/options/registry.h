#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed {

/// The registered methods of one kind, such as the planners. `Entry` has a `name` and, if its
/// methods have options, `defaults`.
template <typename Entry>
class Registry {
 public:
  /// Makes a registry. `kind` is the kind of methods in error messages, such as "planner".
  Registry(const char* kind, std::vector<Entry> entries)
      : kind_(kind), entries_(std::move(entries)) {}

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

  /// Adds an entry. Throws PreconditionError if the name is empty or taken, or if another entry has
  /// the same options type.
  void Add(Entry entry) {
    const std::string name = entry.name;
    TRACKBED_REQUIRE(!name.empty(), "a {} without a name", kind_);
    for (const Entry& other : entries_) {
      TRACKBED_REQUIRE(name != other.name, "a {} named {} is already registered", kind_, name);
      if constexpr (requires { entry.defaults; }) {
        TRACKBED_REQUIRE(!AreOfOneMethod(entry.defaults, other.defaults),
                         "the {} {} has the options type of {}; each needs its own type", kind_,
                         name, other.name);
      }
    }
    entries_.push_back(std::move(entry));
  }

  /// Returns the entry with the given name. Throws InputError, with the most similar name, if there
  /// is no such entry.
  [[nodiscard]] const Entry& Find(const std::string& name) const {
    std::vector<std::string> names;
    for (const Entry& entry : entries_) {
      if (entry.name == name) {
        return entry;
      }
      names.emplace_back(entry.name);
    }
    throw InputError(Problem{.message = "unknown " + (kind_ + (" " + UnknownName(name, names)))});
  }

  /// Returns the entry of the method to which the options belong. Throws InternalError if no
  /// registered method has options of this type.
  template <typename Options>
  [[nodiscard]] const Entry& For(const Options& options) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
      return AreOfOneMethod(entry.defaults, options);
    });
    TRACKBED_CHECK(found != entries_.end(), "options of an unregistered {}", kind_);
    return *found;
  }

 private:
  std::string kind_;
  std::vector<Entry> entries_;
};

}  // namespace trackbed
