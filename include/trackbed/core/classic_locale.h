#pragma once

namespace trackbed {

/// While a ClassicLocale object exists, numbers are read and written in the C locale ("2.5"), even
/// if the program that uses Trackbed has set another locale. The libraries that parse numbers for
/// Trackbed (yaml-cpp, MuJoCo) use the global locale. In a locale that separates thousands by a
/// dot, yaml-cpp and MuJoCo would read "1.500" as 1500.
///
/// The locale is global to the process: while a ClassicLocale object exists, all threads of the
/// program use the C locale. A ClassicLocale object changes nothing if the program already uses the
/// C locale. Several ClassicLocale objects may exist at once, in any threads; when the last of
/// these objects is destroyed, its destructor restores the original locale.
class ClassicLocale {
 public:
  ClassicLocale();
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;
  ~ClassicLocale();
};

}  // namespace trackbed
