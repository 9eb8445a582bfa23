#pragma once

#include <string_view>

/// Parts of a report page except its data. The build assembles these parts from src/report/page/
/// and JavaScript libraries (cmake/ReportPage.cmake).
namespace trackbed {

extern const std::string_view kPageBeforeLiveSource;
extern const std::string_view kLiveSource;  ///< script for the page of a run in progress
extern const std::string_view kPageBeforeTitle;
extern const std::string_view kPageBeforeData;
extern const std::string_view kSceneCanvas;     ///< Part for pages with a scene, before the data.
extern const std::string_view kSceneLibraries;  ///< Part for pages with a scene, after the data.
extern const std::string_view kPageBeforeLiveScript;
extern const std::string_view kLiveScript;  ///< script for the page of a run in progress
extern const std::string_view kPageEnd;

}  // namespace trackbed
