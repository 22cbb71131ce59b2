# Before CPack packs: strips the libraries that come from wheels and lets them find each other and
# nothing else, and gives all files the time SOURCE_DATE_EPOCH, so that the same build gives the same
# bytes. The tools are those of tools/setup.sh wheel.
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
file(GLOB_RECURSE libraries ${CPACK_TEMPORARY_DIRECTORY}/*.so*)
run(strip --strip-unneeded ${libraries})
run(patchelf --set-rpath "$ORIGIN" ${libraries})
file(GLOB_RECURSE third_party ${CPACK_TEMPORARY_DIRECTORY}/THIRD_PARTY.md)
get_filename_component(doc ${third_party} DIRECTORY)
configure_file(${CMAKE_CURRENT_LIST_DIR}/../CHANGELOG.md ${doc}/changelog COPYONLY)
set(usr ${doc}/../../..)
file(MAKE_DIRECTORY ${usr}/share/bash-completion/completions)
execute_process(COMMAND ${usr}/bin/hapticgiant completion bash
  OUTPUT_FILE ${usr}/share/bash-completion/completions/hapticgiant COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND date --utc --rfc-email --date=@$ENV{SOURCE_DATE_EPOCH} OUTPUT_VARIABLE date
  OUTPUT_STRIP_TRAILING_WHITESPACE)
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.Debian.in ${doc}/changelog.Debian @ONLY)
run(gzip --best --no-name ${doc}/changelog ${doc}/changelog.Debian)
run(find ${CPACK_TEMPORARY_DIRECTORY} -exec touch --no-dereference --date=@$ENV{SOURCE_DATE_EPOCH} {} +)
