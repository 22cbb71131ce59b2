# The libraries of wheels that are linked with, and no other file of these wheels, as component
# `libraries`: a tenth of what the wheels have. Debian's are not among them.
list(TRANSFORM wheel_prefix APPEND /lib OUTPUT_VARIABLE wheel_libraries)
install(RUNTIME_DEPENDENCY_SET hg_libraries PRE_EXCLUDE_REGEXES "^ld-linux"
  POST_INCLUDE_REGEXES "/cmeel[.]prefix/" POST_EXCLUDE_REGEXES "." DIRECTORIES ${wheel_libraries}
  LIBRARY DESTINATION ${HG_PROGRAM_PREFIX}${HG_LIBRARIES} COMPONENT libraries)
# They look for others only beside themselves: libqhull_r comes with a folder of the working directory,
# liboctomath with one of /tmp, and both may hold files of other users.
install(CODE "set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${HG_PROGRAM_PREFIX}${HG_LIBRARIES}\")"
  COMPONENT libraries)
install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/library_folders.cmake COMPONENT libraries)
