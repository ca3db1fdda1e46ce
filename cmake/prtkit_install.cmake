# install(), the package that find_package(prtkit) reads, and pkg-config files: one of each per library, so that a
# missing package of one does not break another. `cmake --install` installs the libraries and programs that are built and
# lists those that are not.
include(CMakePackageConfigHelpers)

# prtkit_install_if_built(<target>): installs the component <target> of the install rules where its file is built.
function(prtkit_install_if_built target)
    install(CODE "
        if(EXISTS \"$<TARGET_FILE:${target}>\")
            execute_process(COMMAND \"\${CMAKE_COMMAND}\" --install \"${PROJECT_BINARY_DIR}\"
                --prefix \"\${CMAKE_INSTALL_PREFIX}\" --component ${target} COMMAND_ERROR_IS_FATAL ANY)
        else()
            list(APPEND prtkit_not_built ${target})
        endif()")
endfunction()

# pkg-config's names of packages, and libraries of those that it does not know.
set(pkg_config_of_OpenEXR OpenEXR)
set(pkg_config_of_TinyGLTF tinygltf)
set(pkg_config_of_glfw3 glfw3)
set(pkg_config_of_Vulkan vulkan)
set(pkg_config_of_ZLIB zlib)
set(libraries_of_Threads -pthread)
set(libraries_of_meshoptimizer -lmeshoptimizer)
set(libraries_of_Ceres "-lceres -lglog")
set(libraries_of_embree -lembree3)

# prtkit_links_of(<target>): what linking with an installed <target> takes: `uses`, components of prtkit, and `packages`,
# names for find_package() or PkgConfig::<module>.
function(prtkit_links_of target)
    set(uses "")
    set(packages "")
    get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
    foreach(link IN LISTS links)
        string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link "${link}")
        if(link MATCHES "^prt::(.+)$")
            list(APPEND uses ${CMAKE_MATCH_1})
        elseif(link MATCHES "^PkgConfig::")
            list(APPEND packages ${link})
        elseif(link MATCHES "^([A-Za-z0-9_]+)::")
            list(APPEND packages ${CMAKE_MATCH_1})
        elseif(link STREQUAL "embree")
            list(APPEND packages embree)
        elseif(link STREQUAL "glfw")
            list(APPEND packages glfw3)
        endif()
    endforeach()
    list(REMOVE_DUPLICATES packages)
    set(uses ${uses} PARENT_SCOPE)
    set(packages ${packages} PARENT_SCOPE)
endfunction()

# prtkit_pkg_config(<library> <component>): installs prtkit.pc for the bare runtime, prtkit-<component>.pc for others. All but the C
# interface are static, so that what they are linked with is required of whoever links them.
function(prtkit_pkg_config library component)
    set(PC_NAME prtkit-${component})
    set(PC_LIBS -lprt_${component})
    if(component STREQUAL "runtime")
        set(PC_NAME prtkit)
    elseif(component STREQUAL "c")
        set(PC_LIBS -lprt)
    endif()
    list(TRANSFORM uses PREPEND prtkit-)
    string(REPLACE prtkit-runtime prtkit PC_REQUIRES "${uses}")
    foreach(package IN LISTS packages)
        if(package MATCHES "^PkgConfig::(.+)$")
            list(APPEND PC_REQUIRES ${CMAKE_MATCH_1})
        else()
            list(APPEND PC_REQUIRES ${pkg_config_of_${package}})
            list(APPEND PC_LIBS ${libraries_of_${package}})
        endif()
    endforeach()
    list(JOIN PC_REQUIRES " " PC_REQUIRES)
    list(JOIN PC_LIBS " " PC_LIBS)
    configure_file(cmake/prtkit.pc.in ${PC_NAME}.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${PC_NAME}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT ${library} EXCLUDE_FROM_ALL)
endfunction()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/prtkit)
file(RELATIVE_PATH prefix_from_pkgconfig ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
get_property(libraries GLOBAL PROPERTY PRTKIT_LIBRARIES)
foreach(library IN LISTS libraries)
    get_target_property(component ${library} EXPORT_NAME)
    prtkit_links_of(${library})
    list(APPEND components ${component})
    string(APPEND component_links "set(prtkit_${component}_uses ${uses})\nset(prtkit_${component}_packages ${packages})\n")
    install(TARGETS ${library} EXPORT prtkit-${component}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${library} EXCLUDE_FROM_ALL
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${library} EXCLUDE_FROM_ALL)
    install(EXPORT prtkit-${component} NAMESPACE prt:: DESTINATION ${package_folder}
        COMPONENT ${library} EXCLUDE_FROM_ALL)
    prtkit_pkg_config(${library} ${component})
    prtkit_install_if_built(${library})
endforeach()
configure_package_config_file(cmake/prtkitConfig.cmake.in prtkitConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(prtkitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/prtkitConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/prtkitConfigVersion.cmake
    DESTINATION ${package_folder})

get_property(header_folders GLOBAL PROPERTY PRTKIT_HEADER_FOLDERS)
install(DIRECTORY ${header_folders} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY shaders/ DESTINATION ${CMAKE_INSTALL_DATADIR}/prtkit/shaders)
foreach(program prt prt-viewer)
    if(TARGET ${program})
        install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${program} EXCLUDE_FROM_ALL)
        prtkit_install_if_built(${program})
    endif()
endforeach()
install(CODE "
    if(prtkit_not_built)
        list(JOIN prtkit_not_built \" \" targets)
        message(STATUS \"Not built, so not installed: \${targets}\")
        message(STATUS \"To install them: cmake --build \\\"${PROJECT_BINARY_DIR}\\\" --target \${targets}, then install again\")
    endif()")
