#pragma once

namespace trackbed {

/// While one lives, numbers are read and written as in C: "2.5", whatever the locale of the program
/// that has Trackbed in it. Libraries that read numbers for Trackbed (yaml-cpp, MuJoCo) use the
/// global locale, and where a dot groups thousands, they read 1.500 as 1500.
///
/// The locale is one for all threads: others of the program see the classic one for as long.
/// Nothing is touched in a program that has set none. Several may live at once, in any threads; the
/// last one to go brings back what was before the first.
class ClassicLocale {
 public:
  ClassicLocale();
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;
  ~ClassicLocale();
};

}  // namespace trackbed
