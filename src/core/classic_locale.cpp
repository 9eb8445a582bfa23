#include "trackbed/core/classic_locale.h"

#include <clocale>
#include <locale>
#include <mutex>
#include <string>

namespace trackbed {
namespace {

/// The process's locale before the first ClassicLocale was constructed; the destructor of the last
/// ClassicLocale restores this locale. One saved locale is enough for all ClassicLocale objects,
/// because the locale is global to the process.
struct SavedLocale {
  std::mutex mutex;
  int users = 0;
  bool is_changed = false;
  std::locale cpp_locale;
  std::string c_locale;
};

SavedLocale& GetSavedLocale() {
  static SavedLocale saved;
  return saved;
}

}  // namespace

ClassicLocale::ClassicLocale() {
  SavedLocale& saved = GetSavedLocale();
  const std::lock_guard lock(saved.mutex);
  const bool is_classic =
      std::locale() == std::locale::classic() && *std::localeconv()->decimal_point == '.';
  if (saved.users++ == 0 && !is_classic) {
    saved.c_locale = std::setlocale(LC_ALL, nullptr);
    saved.cpp_locale = std::locale::global(std::locale::classic());
    saved.is_changed = true;
  }
}

ClassicLocale::~ClassicLocale() {
  SavedLocale& saved = GetSavedLocale();
  const std::lock_guard lock(saved.mutex);
  if (--saved.users == 0 && saved.is_changed) {
    std::locale::global(saved.cpp_locale);
    std::setlocale(LC_ALL, saved.c_locale.c_str());
    saved.is_changed = false;
  }
}

}  // namespace trackbed
