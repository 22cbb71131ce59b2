# The C++ package: `cmake --install BUILD --component cpp --prefix PREFIX`, then
# find_package(hapticgiant COMPONENTS ...) gives hapticgiant::MODULE; docs/start/packages.md.
#
# Everything but what only the program needs.
set(HG_PACKAGE core signals model limits hqp estimation rendering prepositioning tracking safety
  controller device udp runtime config simulator teleoperation analysis simulation scenario)
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hapticgiant)

foreach(module IN LISTS HG_PACKAGE)
  set_target_properties(hg_${module} PROPERTIES
    EXPORT_NAME ${module}
    INTERFACE_COMPILE_FEATURES cxx_std_20
    INTERFACE_INCLUDE_DIRECTORIES
      "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>;$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  install(TARGETS hg_${module} EXPORT hapticgiant COMPONENT cpp
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()

set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS cmake/public_headers.txt)
file(STRINGS cmake/public_headers.txt headers REGEX "^hg/")
foreach(header IN LISTS headers)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} COMPONENT cpp)
endforeach()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/models DESTINATION ${CMAKE_INSTALL_DATADIR}/hapticgiant
  COMPONENT cpp)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/driver
  DESTINATION ${CMAKE_INSTALL_DATADIR}/hapticgiant/examples COMPONENT cpp)
install(EXPORT hapticgiant NAMESPACE hapticgiant:: DESTINATION ${package_dir} COMPONENT cpp
  FILE hapticgiantTargets.cmake)
export(EXPORT hapticgiant NAMESPACE hapticgiant:: FILE hapticgiantTargets.cmake)  # for pip
configure_package_config_file(cmake/hapticgiantConfig.cmake.in generated/hapticgiantConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(generated/hapticgiantConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/hapticgiantConfig.cmake
  ${PROJECT_BINARY_DIR}/generated/hapticgiantConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT cpp)

if(HG_TESTS)
  hg_python_test(package_cpp tests/packages/cpp_package_test.py ${PROJECT_BINARY_DIR}
    ${Eigen3_DIR} TIMEOUT 900)
endif()
