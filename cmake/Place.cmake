# trackbed_add_place(FOLDER): the library trackbed_place, which tells where models/ and scenarios/
# lie. Each build writes its own: Trackbed's names the source tree, that of a project which has found
# the installed package the data beside that package. So the libraries hold no path.
function(trackbed_add_place folder)
  set(file ${PROJECT_BINARY_DIR}/trackbed_place/place.cpp)
  file(CONFIGURE OUTPUT ${file} CONTENT [[namespace trackbed {

const char* PlaceOfData();
const char* PlaceOfData() { return R"trackbed(@folder@)trackbed"; }

}  // namespace trackbed
]] @ONLY)
  add_library(trackbed_place STATIC EXCLUDE_FROM_ALL ${file})
endfunction()
