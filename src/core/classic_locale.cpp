#include "trackbed/core/classic_locale.h"

#include <clocale>
#include <locale>
#include <mutex>
#include <string>

namespace trackbed {
namespace {

/// State that is restored when the last user ends. One per process, like the locale.
struct Before {
  std::mutex mutex;
  int users = 0;
  bool is_changed = false;
  std::locale of_cpp;
  std::string of_c;
};

Before& TheBefore() {
  static Before before;
  return before;
}

}  // namespace

ClassicLocale::ClassicLocale() {
  Before& before = TheBefore();
  const std::lock_guard lock(before.mutex);
  const bool is_classic =
      std::locale() == std::locale::classic() && *std::localeconv()->decimal_point == '.';
  if (before.users++ == 0 && !is_classic) {
    before.of_c = std::setlocale(LC_ALL, nullptr);
    before.of_cpp = std::locale::global(std::locale::classic());
    before.is_changed = true;
  }
}

ClassicLocale::~ClassicLocale() {
  Before& before = TheBefore();
  const std::lock_guard lock(before.mutex);
  if (--before.users == 0 && before.is_changed) {
    std::locale::global(before.of_cpp);
    std::setlocale(LC_ALL, before.of_c.c_str());
    before.is_changed = false;
  }
}

}  // namespace trackbed
