#pragma once

#include <string_view>

/// Parts of the page without its data, assembled by the build from src/report/page/ and the
/// libraries (cmake/ReportPage.cmake).
namespace trackbed {

extern const std::string_view kPageBeforeLiveSource;
extern const std::string_view kLiveSource;  ///< for the page of a run in progress
extern const std::string_view kPageBeforeTitle;
extern const std::string_view kPageBeforeData;
extern const std::string_view kSceneCanvas;     ///< for pages with a scene, before the data
extern const std::string_view kSceneLibraries;  ///< for pages with a scene, after the data
extern const std::string_view kPageBeforeLiveScript;
extern const std::string_view kLiveScript;  ///< for the page of a run in progress
extern const std::string_view kPageEnd;

}  // namespace trackbed
