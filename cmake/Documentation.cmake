# Installs README.md, docs/ and all files that these pages link, so that the pages' links and
# pictures work without the source tree. Models, scenarios and headers become links to their
# installed locations; files of tests/, src/ and other folders are copied.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN inputs.sha256 EXCLUDE)

# trackbed_install_link(NAME FOLDER): creates, in the folder of the installed pages, the link NAME
# to the installed FOLDER.
function(trackbed_install_link name folder)
  file(RELATIVE_PATH target /${CMAKE_INSTALL_DOCDIR} /${folder})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/package/links)
  file(CREATE_LINK ${target} ${PROJECT_BINARY_DIR}/package/links/${name} SYMBOLIC)
  install(FILES ${PROJECT_BINARY_DIR}/package/links/${name} DESTINATION ${CMAKE_INSTALL_DOCDIR})
endfunction()
trackbed_install_link(models ${data_folder}/models)
trackbed_install_link(scenarios ${data_folder}/scenarios)
trackbed_install_link(include ${CMAKE_INSTALL_INCLUDEDIR})

install(CODE "set(source \"${PROJECT_SOURCE_DIR}\")\nset(pages_folder \"${CMAKE_INSTALL_DOCDIR}\")")
install(SCRIPT cmake/install_linked.cmake)
