# trackbed_add_place(FOLDER): adds the library trackbed_place, which returns the location of models/
# and scenarios/. Each CMake build generates its own library trackbed_place. In Trackbed's build,
# trackbed_place returns the source tree; in a project that uses the installed package,
# trackbed_place returns the data folder of the package. With this function, the installed libraries
# contain no absolute path.
function(trackbed_add_place folder)
  set(file ${PROJECT_BINARY_DIR}/trackbed_place/place.cpp)
  file(CONFIGURE OUTPUT ${file} CONTENT [[namespace trackbed {

const char* PlaceOfData();
const char* PlaceOfData() { return R"trackbed(@folder@)trackbed"; }

}  // namespace trackbed
]] @ONLY)
  add_library(trackbed_place STATIC EXCLUDE_FROM_ALL ${file})
  set_target_properties(trackbed_place PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()
