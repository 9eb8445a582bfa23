#pragma once

namespace trackbed {

/// While an instance lives, numbers are read and written in the C locale ("2.5"), whatever the
/// locale of the program that uses Trackbed. The libraries that parse numbers for Trackbed
/// (yaml-cpp, MuJoCo) use the global locale; in one in which a dot groups thousands, they read
/// 1.500 as 1500.
///
/// The locale is global to the process: meanwhile, other threads of the program also see the
/// classic one. Does nothing if the program has not set a locale. Several instances may live at
/// once, in any threads; the last one to be destroyed restores the original locale.
class ClassicLocale {
 public:
  ClassicLocale();
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;
  ~ClassicLocale();
};

}  // namespace trackbed
