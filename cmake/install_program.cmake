# The programs with what they look for below their prefix and what their users read, as component
# `program`; the wheel (pyproject.toml, tools/make_wheel.sh) and the Debian package (tools/make_deb.sh)
# are made of it.
# A program that is to be in both says so before this file is included:
# set_property(GLOBAL APPEND PROPERTY HG_PROGRAMS target).
#
# HG_PROGRAM_PREFIX is put before all destinations, "hapticgiant/" in a wheel.
include(GNUInstallDirs)
get_property(programs GLOBAL PROPERTY HG_PROGRAMS)
add_custom_target(hg_programs)
add_dependencies(hg_programs ${programs})
foreach(program IN LISTS programs)
  hg_library_path(${program} ${PROJECT_BINARY_DIR} ../${HG_LIBRARIES})
endforeach()
install(TARGETS ${programs} RUNTIME_DEPENDENCY_SET hg_libraries
  RUNTIME DESTINATION ${HG_PROGRAM_PREFIX}bin COMPONENT program)
include(cmake/install_libraries.cmake)
set(share ${HG_PROGRAM_PREFIX}share/hapticgiant)
set(in_program COMPONENT program PATTERN __pycache__ EXCLUDE PATTERN ".*" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/models DESTINATION ${share} ${in_program})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${share} ${in_program})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${share} COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.csv" PATTERN images EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${share} COMPONENT program)
# the problem file of examples in docs and helps
install(FILES ${PROJECT_SOURCE_DIR}/tests/reference/exc_two.hqp.gz DESTINATION ${share}/tests/reference
  COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/viewer/dist DESTINATION ${share}/viewer OPTIONAL ${in_program})
install(FILES ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md DESTINATION ${HG_PROGRAM_PREFIX}share/doc/hapticgiant
  COMPONENT program)
# the licences in full, which `tools/third_party.py --texts` writes for who gives the package away
install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${HG_PROGRAM_PREFIX}share/doc/hapticgiant
  COMPONENT program OPTIONAL)
if(SKBUILD)
  return()
endif()

# What a wheel has from other wheels and from its Python package
if(TARGET hapticgiant-ros2)  # not in a wheel, which would have to bring Fast DDS and OpenSSL, 15 MB
  install(TARGETS hapticgiant-ros2 RUNTIME DESTINATION bin COMPONENT debian)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/python/hapticgiant/as_folder.py
  ${PROJECT_SOURCE_DIR}/python/hapticgiant/command_line.py
  ${PROJECT_SOURCE_DIR}/python/hapticgiant/figures.py
  ${PROJECT_SOURCE_DIR}/python/hapticgiant/samples.py
  DESTINATION ${share}/python/hapticgiant COMPONENT debian)
foreach(part report sweep study imus design render)
  list(APPEND python_parts ${PROJECT_SOURCE_DIR}/python/hapticgiant/${part})
endforeach()
install(DIRECTORY ${python_parts}
  DESTINATION ${share}/python/hapticgiant COMPONENT debian PATTERN __pycache__ EXCLUDE)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program libraries debian)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/finish_package.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The authors of HapticGiant <nobody@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "large robot as a kinesthetic haptic interface")
set(CPACK_PACKAGE_DESCRIPTION "A person holds the handle of a robot and feels the digital twin of any
serial chain: a door, an excavator, a free tool, any URDF. This package has the
program, a page for the browser, models, a simulated machine and reports.")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${wheel_prefix}/lib)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-scipy, python3-matplotlib, python3-jinja2, python3-yaml")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-aiohttp, python3-statsmodels")  # of user studies
include(CPack)
