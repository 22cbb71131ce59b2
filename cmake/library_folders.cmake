# Leaves the libraries in `folder` only those entries of their RUNPATH that begin where they are.
#
#   cmake -D folder=FOLDER -P cmake/library_folders.cmake
file(GLOB libraries "${folder}/*.so*")
foreach(library IN LISTS libraries)
  foreach(kind RPATH RUNPATH)
    unset(found)  # READ_ELF leaves it where there is none
    file(READ_ELF ${library} ${kind} found)
    set(kept ${found})
    list(FILTER kept INCLUDE REGEX "^[$]ORIGIN(/|$)")
    if(NOT "${kept}" STREQUAL "${found}")
      list(JOIN kept ":" kept)
      file(RPATH_SET FILE ${library} NEW_RPATH "${kept}")
    endif()
  endforeach()
endforeach()
