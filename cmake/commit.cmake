# Writes FILE with the commit of SOURCE, unless it says so already: cmake -DSOURCE=... -DFILE=... -P
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT [[
/// Made by each build.
#pragma once

namespace hg::bench {

inline constexpr const char* kCommit = "@commit@";

}  // namespace hg::bench
]] @ONLY)
