# Compiler options by kind of code:
#   loop      the control cycle, and what simulates a machine: as fast as it gets
#   solver    the same with Eigen under a name of its own, so that a consumer of the package with
#             other vector flags does not share its functions
#   offline   what reads files, serves pages, judges runs: a short build counts more
#   scenario  the same for what plays or inspects whole scenarios
# and of each kind but offline its test programs: loop_test, solver_test, scenario_test.
#
# Each kind has precompiled headers. They save time and nothing else: a file includes what it uses,
# and compiles without them (HG_PRECOMPILE=OFF).
option(HG_PRECOMPILE "Compile the headers that many files include once" ON)

# the macro that tinyxml2 requires of its users, so that they can share headers with all others
add_compile_definitions(_FILE_OFFSET_BITS=64)
# the memory is there, and tidying it up takes a fifth of the time
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(--param=ggc-min-heapsize=400000)
endif()

# What makes an error in memory end the program instead of being used: stack protectors, checked
# calls of the C library, position-independent code, and a table of functions that is read-only
# after the start. Sanitizers see more than the first two, and differently.
include(CheckPIESupported)
check_pie_supported()
if(NOT HG_SANITIZE)
  add_compile_options(-fstack-protector-strong
    "$<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3>")
endif()
add_link_options(-Wl,-z,relro,-z,now,-z,noexecstack)
# The checks of the C++ library, such as an index beyond a vector's end. Kinds loop and solver are
# without: what they cost the control cycle has not been measured.
set(HG_CHECKED _GLIBCXX_ASSERTIONS)

# What the control cycle has no use for, and its results do not depend on to the last bit: functions
# that another library may replace, errno of the mathematical ones, and floating-point traps.
set(fast -fno-semantic-interposition -fno-math-errno -fno-trapping-math)

# Sources are compiled several together (tools/together.py says which), and each compiles alone.
option(HG_TOGETHER "Compile several sources as one" ON)
if(HG_TOGETHER)
  find_program(HG_PYTHON NAMES python3 python REQUIRED)
  set(together ${PROJECT_BINARY_DIR}/together.cmake)
  execute_process(COMMAND ${HG_PYTHON} ${PROJECT_SOURCE_DIR}/tools/together.py ${together}
    COMMAND_ERROR_IS_FATAL ANY)
  include(${together})
  # g++ 12 says these of sources that it says nothing of alone
  add_compile_options(-Wno-subobject-linkage -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
    -Wno-shadow -Wshadow=local)
endif()

# hg_kind(NAME [SHORT_BUILD] [FLAGS flag...] HEADERS file... LINKS library... [DEFINITIONS macro...])
function(hg_kind name)
  cmake_parse_arguments(ARG "SHORT_BUILD" "" "FLAGS;HEADERS;LINKS;DEFINITIONS" ${ARGN})
  if(ARG_SHORT_BUILD)
    set(ARG_FLAGS $<$<CONFIG:Release>:-O1>)
  endif()
  foreach(library IN LISTS ARG_LINKS)
    list(APPEND ARG_DEFINITIONS $<TARGET_PROPERTY:${library},INTERFACE_COMPILE_DEFINITIONS>)
  endforeach()
  foreach(property FLAGS HEADERS LINKS DEFINITIONS)
    set(HG_KIND_${name}_${property} ${ARG_${property}} PARENT_SCOPE)
  endforeach()
endfunction()

set(others ${PROJECT_SOURCE_DIR}/cmake/precompiled/others.h)
set(scenario ${PROJECT_SOURCE_DIR}/cmake/precompiled/scenario.h)
set(test <gtest/gtest.h>)
set(own_eigen Eigen=hg_hqp_eigen)
hg_kind(loop FLAGS ${fast} HEADERS ${others} LINKS Eigen3::Eigen)
hg_kind(solver FLAGS ${fast} HEADERS ${others} LINKS Eigen3::Eigen DEFINITIONS ${own_eigen})
hg_kind(offline SHORT_BUILD HEADERS ${others} <fmt/format.h> LINKS Eigen3::Eigen fmt::fmt
  DEFINITIONS ${HG_CHECKED})
hg_kind(scenario SHORT_BUILD HEADERS ${others} <fmt/format.h> ${scenario}
  LINKS Eigen3::Eigen fmt::fmt DEFINITIONS ${HG_CHECKED})
hg_kind(loop_test SHORT_BUILD HEADERS ${others} ${test} LINKS Eigen3::Eigen GTest::gtest
  DEFINITIONS ${HG_CHECKED})
hg_kind(solver_test SHORT_BUILD HEADERS ${others} ${test} LINKS Eigen3::Eigen GTest::gtest
  DEFINITIONS ${own_eigen} ${HG_CHECKED})
hg_kind(scenario_test SHORT_BUILD HEADERS ${others} ${test} ${scenario}
  LINKS Eigen3::Eigen GTest::gtest DEFINITIONS ${HG_CHECKED})

# hg_build_kind(TARGET KIND)
function(hg_build_kind target kind)
  target_compile_options(${target} PRIVATE ${HG_KIND_${kind}_FLAGS})
  target_compile_definitions(${target} PRIVATE ${HG_KIND_${kind}_DEFINITIONS})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${HG_TOGETHER} UNITY_BUILD_MODE GROUP)
  if(NOT HG_PRECOMPILE)
    return()
  endif()
  set(donor hg_precompiled_${kind})
  if(NOT TARGET ${donor})
    add_library(${donor} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled/empty.cpp)
    target_compile_options(${donor} PRIVATE ${HG_KIND_${kind}_FLAGS})
    target_compile_definitions(${donor} PRIVATE ${HG_KIND_${kind}_DEFINITIONS})
    target_include_directories(${donor} PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${donor} PRIVATE ${HG_KIND_${kind}_LINKS})
    target_precompile_headers(${donor} PRIVATE ${HG_KIND_${kind}_HEADERS})
    get_target_property(is_pic ${target} POSITION_INDEPENDENT_CODE)
    set_target_properties(${donor} PROPERTIES POSITION_INDEPENDENT_CODE ${is_pic})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${donor})
endfunction()

# hg_library_path(TARGET OUTPUT FOLDER...)
# Where the target, built in the folder OUTPUT, looks for libraries: the wheels of .venv, and each
# FOLDER; all relative to its own folder, so that it is the same where it is built and installed.
# Where the two differ, CMake ends the RUNPATH of the build with an empty entry, and an empty entry is
# the working directory.
function(hg_library_path target output)
  if(NOT SKBUILD)
    foreach(prefix IN LISTS wheel_prefix)
      file(RELATIVE_PATH wheels ${output} ${prefix}/lib)
      list(APPEND ARGN ${wheels})
    endforeach()
  endif()
  list(TRANSFORM ARGN PREPEND "$ORIGIN/")
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "${ARGN}" BUILD_WITH_INSTALL_RPATH ON)
endfunction()
