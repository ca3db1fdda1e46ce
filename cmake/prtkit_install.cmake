# install() and the package that find_package(prtkit) reads.
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY PRTKIT_LIBRARIES)
get_property(header_folders GLOBAL PROPERTY PRTKIT_HEADER_FOLDERS)
install(TARGETS ${libraries} EXPORT prtkit ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${header_folders} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY shaders/ DESTINATION ${CMAKE_INSTALL_DATADIR}/prtkit/shaders)
install(EXPORT prtkit NAMESPACE prt:: FILE prtkitTargets.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/prtkit)
foreach(program prt prt-viewer)
    if(TARGET ${program})
        install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    endif()
endforeach()

configure_package_config_file(cmake/prtkitConfig.cmake.in prtkitConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/prtkit)
write_basic_package_version_file(prtkitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/prtkitConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/prtkitConfigVersion.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/prtkit)

# pkg-config: prtkit for the bare runtime in C++, prtkit-c for the C interface.
file(RELATIVE_PATH prefix_from_pkgconfig ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
foreach(name prtkit prtkit-c)
    configure_file(cmake/${name}.pc.in ${name}.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
