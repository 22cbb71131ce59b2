# The fuzzing programs, with clang in the preset `fuzz`; `make fuzz` builds and runs them.
if(HG_SANITIZE MATCHES "fuzzer")
  function(hg_fuzz name)
    add_executable(fuzz_${name} EXCLUDE_FROM_ALL tests/fuzz/entry.cpp tests/fuzz/${name}.cpp)
    target_compile_definitions(fuzz_${name} PRIVATE HG_FUZZ_TARGET=${name})
    target_link_libraries(fuzz_${name} PRIVATE ${ARGN} -fsanitize=fuzzer)
  endfunction()
  # what judges the solver is four times as fast without
  target_compile_options(hg_hqp_checks PRIVATE -fno-sanitize=all)
  hg_fuzz(hqp_reader hg_hqp_checks)
  hg_fuzz(hqp_solver hg_hqp_checks)
  hg_fuzz(config hg_simulation)
  hg_fuzz(urdf hg_model)
  hg_fuzz(protocol hg_udp)
  hg_fuzz(commands hg_viewer_server)
  hg_fuzz(live hg_live)
  hg_fuzz(recording hg_recording)
endif()

# the inputs that fuzzing has found worth keeping, in every build
file(GLOB fuzz_sources CONFIGURE_DEPENDS tests/fuzz/*.cpp)
list(REMOVE_ITEM fuzz_sources ${PROJECT_SOURCE_DIR}/tests/fuzz/entry.cpp)
hg_test(fuzz_replay_test KIND loop_test SOURCES ${fuzz_sources}
  LINKS hg_hqp_checks hg_simulation hg_udp hg_viewer_server hg_live hg_recording)
