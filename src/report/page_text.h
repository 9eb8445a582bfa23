#pragma once

#include <string_view>

/// The page without its data: src/report/page/ and the libraries that it needs, put together by the
/// build (cmake/ReportPage.cmake).
namespace trackbed {

extern const std::string_view kPageBeforeLiveSource;
extern const std::string_view kLiveSource;  ///< of the page of a run that goes on
extern const std::string_view kPageBeforeTitle;
extern const std::string_view kPageBeforeData;
extern const std::string_view kSceneCanvas;     ///< of pages with a scene, before the data
extern const std::string_view kSceneLibraries;  ///< of pages with a scene, after the data
extern const std::string_view kPageBeforeLiveScript;
extern const std::string_view kLiveScript;  ///< of the page of a run that goes on
extern const std::string_view kPageEnd;

}  // namespace trackbed
