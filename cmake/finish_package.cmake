# Adds the files that Debian's policy requires to the package. cpack runs this script after
# installing all other files into the folder to be packed.
set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX})
set(doc ${root}/share/doc/trackbed)

# Move the zsh completions to vendor-completions, where Debian's zsh looks for the completions of
# packages.
file(MAKE_DIRECTORY ${root}/share/zsh)
file(RENAME ${root}/share/zsh/site-functions ${root}/share/zsh/vendor-completions)

file(COPY ${CPACK_TRACKBED_FILES}/copyright ${CPACK_TRACKBED_FILES}/licenses DESTINATION ${doc})
file(COPY ${CPACK_TRACKBED_FILES}/changelog DESTINATION ${doc})
file(GLOB pages ${root}/share/man/man1/*.1)
# The option -n of gzip omits the name and the time of a file, so that equal inputs yield equal
# packages.
execute_process(COMMAND gzip -9n ${doc}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)

file(MAKE_DIRECTORY ${root}/share/lintian/overrides)
file(COPY_FILE ${CPACK_TRACKBED_PACKAGING}/lintian-overrides ${root}/share/lintian/overrides/trackbed)

# Strip the debug symbols in this script, because CPACK_STRIP_FILES skips static libraries and files
# that this build did not compile.
file(GLOB libraries ${root}/lib/*.a)
execute_process(COMMAND strip --strip-debug --remove-section=.comment --remove-section=.note
                        --enable-deterministic-archives ${libraries} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB mujoco ${root}/lib/trackbed/mujoco/lib/libmujoco.so.*)
if(mujoco)
  execute_process(COMMAND strip --strip-unneeded ${mujoco} COMMAND_ERROR_IS_FATAL ANY)
endif()

# Finds the Debian packages of the libraries that the program and the packaged MuJoCo link. If CPack
# called dpkg-shlibdeps itself, CPack would first inspect each of about a thousand files.
set(work ${CPACK_TEMPORARY_DIRECTORY}.shlibdeps)
file(WRITE ${work}/debian/control "")
execute_process(
  COMMAND dpkg-shlibdeps --ignore-missing-info -l${root}/lib/trackbed/mujoco/lib -O ${root}/bin/trackbed ${mujoco}
  WORKING_DIRECTORY ${work} OUTPUT_VARIABLE linked ERROR_VARIABLE messages RESULT_VARIABLE code OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT code EQUAL 0 OR NOT linked MATCHES "^shlibs:Depends=(.+)$")
  message(FATAL_ERROR "dpkg-shlibdeps says (${code}):\n${linked}\n${messages}")
endif()
string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", ${CMAKE_MATCH_1}")
