# Generates the C++ file with the report page from src/report/page/ and the JavaScript libraries,
# whenever one of these files changes.
set(page_folder ${PROJECT_SOURCE_DIR}/src/report/page)
set(page_text ${PROJECT_BINARY_DIR}/report/page_text.cpp)
file(GLOB page_parts CONFIGURE_DEPENDS ${page_folder}/*)
add_custom_command(
  OUTPUT ${page_text}
  COMMAND
    ${CMAKE_COMMAND} -DPAGE=${page_folder} -DD3_SCRIPT=${D3_SCRIPT} -DD3_LICENSE=${D3_LICENSE}
    -DDYGRAPHS_SCRIPT=${DYGRAPHS_SCRIPT} -DDYGRAPHS_STYLE=${DYGRAPHS_STYLE}
    -DDYGRAPHS_LICENSE=${DYGRAPHS_LICENSE} -DTHREE_SCRIPT=${THREE_SCRIPT}
    -DORBIT_CONTROLS_SCRIPT=${ORBIT_CONTROLS_SCRIPT} -DTHREE_LICENSE=${THREE_LICENSE} -DOUTPUT=${page_text} -P
    ${PROJECT_SOURCE_DIR}/cmake/report_page.cmake
  DEPENDS ${page_parts} ${D3_SCRIPT} ${D3_LICENSE} ${DYGRAPHS_SCRIPT} ${DYGRAPHS_STYLE}
          ${DYGRAPHS_LICENSE} ${THREE_SCRIPT} ${ORBIT_CONTROLS_SCRIPT} ${THREE_LICENSE} ${PROJECT_SOURCE_DIR}/cmake/report_page.cmake
  COMMENT "Putting the page of the reports together"
  VERBATIM)
target_sources(trackbed_report PRIVATE ${page_text})
# With this target, Ninja can build the report page alone; to build the page through the module, Ninja
# would first build all modules below it.
add_custom_target(trackbed_page_text DEPENDS ${page_text})
add_dependencies(trackbed_report trackbed_page_text)
