# The libraries of wheels that are linked with, and no other file of these wheels, as component
# `libraries`: a tenth of what the wheels have. Debian's are not among them.
list(TRANSFORM wheel_prefix APPEND /lib OUTPUT_VARIABLE wheel_libraries)
install(RUNTIME_DEPENDENCY_SET hg_libraries PRE_EXCLUDE_REGEXES "^ld-linux"
  POST_INCLUDE_REGEXES "/cmeel[.]prefix/" POST_EXCLUDE_REGEXES "." DIRECTORIES ${wheel_libraries}
  LIBRARY DESTINATION ${HG_PROGRAM_PREFIX}${HG_LIBRARIES} COMPONENT libraries)
# One of them looks for others in a folder of the working directory, which may hold untrusted files.
install(CODE "set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${HG_PROGRAM_PREFIX}${HG_LIBRARIES}\")"
  COMPONENT libraries)
install(CODE [[
  file(GLOB libraries "${folder}/*.so*")
  foreach(library IN LISTS libraries)
    file(READ_ELF ${library} RUNPATH found)
    if(found AND NOT found MATCHES "^[$]ORIGIN")
      file(RPATH_REMOVE FILE ${library})
    endif()
  endforeach()]] COMPONENT libraries)
