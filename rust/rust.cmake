# The library hg_rust: the official MCAP writer and the EtherCAT master in Rust, or without a working
# Rust toolchain a stand-in with which the program builds and says that both are off. One library,
# because a second one would define Rust's own symbols again.
#
# HG_CARGO names a cargo; empty: the first in PATH, then in /usr/bin, that runs, has a rustc beside
# it that is new enough and has (or can download) the crates of Cargo.lock; OFF: neither of them.
set(HG_CARGO "" CACHE STRING
  "cargo for recording and EtherCAT; empty = search, OFF = build without them")
set(rust_dir ${CMAKE_CURRENT_LIST_DIR})
set(rust_parts ${PROJECT_SOURCE_DIR}/hg/recording/mcap_sink
  ${PROJECT_SOURCE_DIR}/hg/device/ethercat/bus_master)

file(STRINGS ${rust_dir}/Cargo.toml least_rust REGEX "^rust-version")
string(REGEX MATCH "[0-9.]+" least_rust "${least_rust}")

# A cargo in PATH may be a proxy without a toolchain, or too old: try before trusting.
function(hg_find_cargo result)
  string(REPLACE ":" ";" folders "$ENV{PATH}")
  list(TRANSFORM folders APPEND /cargo)
  set(candidates ${HG_CARGO})
  if(NOT candidates)
    set(candidates ${folders} /usr/bin/cargo)
    list(REMOVE_DUPLICATES candidates)
  endif()
  set(reason "found none with a rustc beside it")
  foreach(cargo IN LISTS candidates)
    get_filename_component(folder ${cargo} DIRECTORY)
    if(NOT EXISTS ${cargo} OR NOT EXISTS ${folder}/rustc)
      continue()
    endif()
    execute_process(COMMAND ${folder}/rustc --version RESULT_VARIABLE failed
      OUTPUT_VARIABLE version ERROR_VARIABLE reason)
    if(failed)
      continue()
    endif()
    string(REGEX MATCH "[0-9.]+" version "${version}")
    if(version VERSION_LESS least_rust)
      set(reason "${folder}/rustc is ${version}, needed is ${least_rust}")
      continue()
    endif()
    execute_process(
      COMMAND ${CMAKE_COMMAND} -E env RUSTC=${folder}/rustc
        ${cargo} fetch --locked --quiet --manifest-path ${rust_dir}/Cargo.toml
      RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE reason)
    if(NOT failed)
      set(${result} ${cargo} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  string(REGEX REPLACE "\n.*" "" reason "${reason}")
  set(${result} "" PARENT_SCOPE)
  set(${result}_reason "no usable cargo (${reason})" PARENT_SCOPE)
endfunction()

set(cargo "")
set(cargo_reason "HG_CARGO is OFF")
if(NOT "${HG_CARGO}" STREQUAL "OFF")
  hg_find_cargo(cargo)
endif()
if(NOT cargo AND HG_REQUIRE_TESTS)
  message(FATAL_ERROR "Recording is off, and EtherCAT: ${cargo_reason}.")
elseif(NOT cargo)
  message(STATUS "Recording is off, and EtherCAT: ${cargo_reason}.")
endif()

if(cargo)
  set(target_dir ${PROJECT_SOURCE_DIR}/build/rust)  # the same for all presets
  set(library ${target_dir}/release/libhg_rust.a)
  set(rust_globs ${rust_dir} ${rust_parts})
  list(TRANSFORM rust_globs APPEND /src/*.rs)
  file(GLOB rust_sources CONFIGURE_DEPENDS ${rust_globs})
  set(rust_manifests ${rust_parts})
  list(TRANSFORM rust_manifests APPEND /Cargo.toml)
  get_filename_component(folder ${cargo} DIRECTORY)
  # the system's zstd where it is there: compiling the one in the crate takes longer than all the rest
  set(environment RUSTC=${folder}/rustc CARGO_TARGET_DIR=${target_dir})
  find_package(PkgConfig QUIET)
  if(PkgConfig_FOUND)
    pkg_check_modules(zstd QUIET IMPORTED_TARGET libzstd)
  endif()
  if(zstd_FOUND)
    list(APPEND environment ZSTD_SYS_USE_PKG_CONFIG=1)
    set(zstd_target PkgConfig::zstd)
  endif()
  add_custom_command(
    OUTPUT ${library}
    COMMAND ${CMAKE_COMMAND} -E env ${environment}
      ${cargo} build --release --locked --offline --quiet
    WORKING_DIRECTORY ${rust_dir}
    DEPENDS ${rust_sources} ${rust_manifests} ${rust_dir}/Cargo.toml ${rust_dir}/Cargo.lock
    COMMENT "Building the MCAP writer and the EtherCAT master (Rust)"
    VERBATIM)
  add_custom_target(hg_rust_build DEPENDS ${library})
  add_library(hg_rust STATIC IMPORTED GLOBAL)
  add_dependencies(hg_rust hg_rust_build)
  set_target_properties(hg_rust PROPERTIES
    IMPORTED_LOCATION ${library}
    INTERFACE_LINK_LIBRARIES "${zstd_target};Threads::Threads;${CMAKE_DL_LIBS};m")
else()
  list(TRANSFORM rust_parts APPEND /without_rust.cpp)
  add_library(hg_rust STATIC ${rust_parts})
  target_include_directories(hg_rust PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(hg_rust PUBLIC Threads::Threads)
endif()

# A recording as the official Python reader sees it.
if(cargo)
  add_executable(recording_example hg/recording/test/recording_example.cpp)
  target_link_libraries(recording_example PRIVATE hg_recording)
  hg_python_test(recording_read hg/recording/test/read_recording.py
    $<TARGET_FILE:recording_example>)
endif()
