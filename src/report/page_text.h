#pragma once

#include <string_view>

/// Text parts of a report page, without the page's data. The build assembles the text of the page
/// from src/report/page/ and JavaScript libraries (cmake/ReportPage.cmake).
namespace trackbed {

extern const std::string_view kPageBeforeLiveSource;
extern const std::string_view kLiveSource;  ///< JavaScript of the page of a run in progress
extern const std::string_view kPageBeforeTitle;
extern const std::string_view kPageBeforeData;
/// Part of pages with a 3D scene, inserted before the data.
extern const std::string_view kSceneCanvas;
/// Part of pages with a 3D scene, inserted after the data.
extern const std::string_view kSceneLibraries;
extern const std::string_view kPageBeforeLiveScript;
extern const std::string_view kLiveScript;  ///< JavaScript of the page of a run in progress
extern const std::string_view kPageEnd;

}  // namespace trackbed
