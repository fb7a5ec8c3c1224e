# `cmake --install` gives headers, library, program and a package for find_package(raygrain).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/raygrain)
install(TARGETS raygrain EXPORT raygrain-targets)
install(DIRECTORY include/raygrain TYPE INCLUDE)
install(FILES LICENSE README.md CHANGELOG.md TYPE DOC)
install(EXPORT raygrain-targets NAMESPACE raygrain:: DESTINATION ${package_dir})
configure_package_config_file(cmake/raygrain-config.cmake.in ${PROJECT_BINARY_DIR}/raygrain-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/raygrain-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/raygrain-config.cmake ${PROJECT_BINARY_DIR}/raygrain-config-version.cmake
        DESTINATION ${package_dir})
# The interactive page of `raygrain report`, where it was built (make report-page).
install(FILES ${PROJECT_BINARY_DIR}/share/raygrain/report-page.html DESTINATION share/raygrain OPTIONAL)
