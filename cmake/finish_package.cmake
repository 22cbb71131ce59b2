# Before CPack packs: strips the libraries that come from wheels, and gives all files the time
# SOURCE_DATE_EPOCH, so that the same build gives the same bytes.
execute_process(COMMAND find ${CPACK_TEMPORARY_DIRECTORY} -name *.so*
  -exec strip --strip-unneeded {} + COMMAND_ERROR_IS_FATAL ANY)
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND find ${CPACK_TEMPORARY_DIRECTORY}
    -exec touch --no-dereference --date=@$ENV{SOURCE_DATE_EPOCH} {} + COMMAND_ERROR_IS_FATAL ANY)
endif()
