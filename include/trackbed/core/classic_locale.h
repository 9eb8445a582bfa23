#pragma once

namespace trackbed {

/// While an instance lives, numbers are read and written in the C locale ("2.5"), even if the
/// program that uses Trackbed has set another locale. The libraries that parse numbers for Trackbed
/// (yaml-cpp, MuJoCo) use the global locale. In a locale with a dot between thousands, these
/// libraries would read 1.500 as 1500.
///
/// The locale is global to the process: other threads of the program also see the classic locale
/// while an instance lives. An instance does nothing if the program has not set a locale. Several
/// instances may live at once, in any threads; the last instance to be destroyed restores the
/// original locale.
class ClassicLocale {
 public:
  ClassicLocale();
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;
  ~ClassicLocale();
};

}  // namespace trackbed
