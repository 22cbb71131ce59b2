# The simulated EtherCAT segment, a program in Rust, what judges it, two masters of others, and what
# `hapticgiant bus` finds on it; and the HapticGiant on such a segment, from the door to its plant.
# Without cargo there is none of it; without the crates of one master the other one judges alone.

# hg_rust_program(RESULT FOLDER LEAST_RUST): a program of tests/ethercat/FOLDER, and in RESULT where
# it will be; empty where it cannot be built.
function(hg_rust_program result folder least)
  set(${result} "" PARENT_SCOPE)
  set(source ${PROJECT_SOURCE_DIR}/tests/ethercat/${folder})
  get_filename_component(tools ${cargo} DIRECTORY)
  execute_process(COMMAND ${tools}/rustc --version OUTPUT_VARIABLE version)
  string(REGEX MATCH "[0-9.]+" version "${version}")
  if(version VERSION_LESS least)
    message(STATUS "No ${folder}: rustc is ${version}, needed is ${least}.")
    return()
  endif()
  set(environment ${CMAKE_COMMAND} -E env RUSTC=${tools}/rustc
    CARGO_TARGET_DIR=${PROJECT_SOURCE_DIR}/build/ethercat)  # the same for all presets
  execute_process(COMMAND ${environment} ${cargo} fetch --locked --quiet
    WORKING_DIRECTORY ${source} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE reason)
  if(failed)
    string(REGEX REPLACE "\n.*" "" reason "${reason}")
    message(STATUS "No ${folder}: ${reason}")
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${source}/src/*.rs)
  set(file ${PROJECT_SOURCE_DIR}/build/ethercat/release/${folder})
  add_custom_command(OUTPUT ${file}
    COMMAND ${environment} ${cargo} build --release --locked --offline --quiet
    WORKING_DIRECTORY ${source}
    DEPENDS ${sources} ${source}/Cargo.toml ${source}/Cargo.lock
      ${PROJECT_SOURCE_DIR}/hg/device/ethercat/bus_master/src/link.rs
      ${PROJECT_SOURCE_DIR}/hg/device/ethercat/bus_master/src/pump.rs
    COMMENT "Building ${folder} (Rust)"
    VERBATIM)
  add_custom_target(${folder} ALL DEPENDS ${file})
  set(${result} ${file} PARENT_SCOPE)
endfunction()

if(cargo AND HG_TESTS)
  hg_rust_program(segment_program segment 1.81)
  hg_rust_program(ethercrab_program ethercrab_master 1.85)
  if(segment_program)
    hg_python_test(ethercat_bus tests/ethercat/ethercat_test.py ${program} ${segment_program} ${ethercrab_program}
      TIMEOUT 300)
    hg_python_test(ethercat_machine tests/ethercat/machine_test.py ${program} ${segment_program}
      TIMEOUT 300)
    set_tests_properties(ethercat_bus ethercat_machine PROPERTIES SKIP_RETURN_CODE 77)
  endif()
endif()
