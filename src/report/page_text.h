#pragma once

#include <string_view>

/// The page without its data: src/report/page/ and the libraries that it needs, put together by the
/// build (cmake/ReportPage.cmake).
namespace trackbed {

extern const std::string_view kPageBeforeTitle;
extern const std::string_view kPageBeforeData;
extern const std::string_view
    kSceneLibraries;  ///< of pages with a scene, before what is after the data
extern const std::string_view kPageAfterData;

}  // namespace trackbed
