# What cmake --install puts where: the program, the shared library, its header, and what find_package(alhazen) reads.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

if(TARGET alhazen)
    install(TARGETS alhazen RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS alhazen_library EXPORT alhazen
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/alhazen DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/alhazen)
install(EXPORT alhazen NAMESPACE alhazen:: FILE alhazen-targets.cmake DESTINATION ${package_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/alhazen-config.cmake.in
                              ${PROJECT_BINARY_DIR}/alhazen-config.cmake INSTALL_DESTINATION ${package_folder})
# Until 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/alhazen-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/alhazen-config.cmake ${PROJECT_BINARY_DIR}/alhazen-config-version.cmake
        DESTINATION ${package_folder})
