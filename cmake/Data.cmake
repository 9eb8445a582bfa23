# Lets the module sim find the folders models/ and scenarios/, even though no installed file
# contains an absolute path. DataFolder (trackbed/sim/scene.h) looks beside the program first, then
# in the result of PlaceOfData. The definition of PlaceOfData depends on the build:
#   shared library of sim   the folder beside the library
#   static libraries        a source file written by each CMake build (Place.cmake); in other builds
#                           libtrackbed_default_place.a, which trackbed.pc links, reports an error
#                           that asks for TRACKBED_DATA
include(Place)
set(data /${CMAKE_INSTALL_DATADIR}/trackbed)
file(RELATIVE_PATH data_from_program /${CMAKE_INSTALL_BINDIR} ${data})
file(RELATIVE_PATH data_from_library /${CMAKE_INSTALL_LIBDIR} ${data})
target_compile_definitions(trackbed_sim PRIVATE TRACKBED_DATA_FROM_PROGRAM="${data_from_program}")
if(BUILD_SHARED_LIBS)
  target_sources(trackbed_sim PRIVATE src/sim/place/beside_library.cpp)
  target_compile_definitions(trackbed_sim PRIVATE TRACKBED_DATA_FROM_LIBRARY="${data_from_library}")
  target_link_libraries(trackbed_sim PRIVATE ${CMAKE_DL_LIBS})
else()
  trackbed_add_place(${PROJECT_SOURCE_DIR})
  target_link_libraries(trackbed_sim PRIVATE $<BUILD_INTERFACE:trackbed_place>
                                             $<INSTALL_INTERFACE:trackbed::place>)
  add_library(trackbed_default_place STATIC src/sim/place/unknown.cpp)
  set_target_properties(trackbed_default_place PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(trackbed_default_place PRIVATE trackbed_core trackbed_compiler)
endif()
