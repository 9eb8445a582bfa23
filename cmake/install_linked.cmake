# Installs into pages_folder the files and folders of `source` that the pages link and that no other
# rule installs: files and folders in tests/, src/, render/, cmake/, scripts/, packaging/, bench/
# and .ci/.
file(GLOB_RECURSE pages ${source}/docs/*.md)
list(APPEND pages ${source}/README.md ${source}/CHANGELOG.md ${source}/CONTRIBUTING.md)
set(linked "")
foreach(page IN LISTS pages)
  get_filename_component(folder ${page} DIRECTORY)
  file(READ ${page} text)
  # Remove the square brackets of Markdown links, because CMake does not split a list at semicolons
  # between brackets.
  string(REPLACE "](" "LINK:" text "${text}")
  string(REGEX MATCHALL "LINK:[^)#: ;]+" links "${text}")
  foreach(link IN LISTS links)
    string(REPLACE "LINK:" "" link ${link})
    file(RELATIVE_PATH file ${source} ${folder}/${link})
    if(file MATCHES "^(tests|src|render|cmake|scripts|packaging|bench|\\.ci)/" AND EXISTS ${source}/${file})
      list(APPEND linked ${file})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES linked)
foreach(file IN LISTS linked)
  get_filename_component(folder ${pages_folder}/${file} DIRECTORY)
  file(INSTALL ${source}/${file} DESTINATION ${CMAKE_INSTALL_PREFIX}/${folder} MESSAGE_NEVER)
endforeach()
