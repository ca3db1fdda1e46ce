# Tests the installed package in projects that are independent of this build.
if(NOT TARGET prt OR NOT TARGET example_scenes OR PRTKIT_SANITIZED)
    return()
endif()
set(installed ${PRTKIT_TESTS_BINARY_DIR}/installed)
set(hidden_packages Ceres CLI11 Eigen3 embree fmt glfw3 nlohmann_json OpenEXR PkgConfig TinyGLTF)
add_test(NAME install COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${installed})
set_tests_properties(install PROPERTIES FIXTURES_SETUP installed)

# prtkit_installed_test(<name> <folder> [OPTIONS <option>...] COMMAND <program> ...): builds a project and runs its
# program.
function(prtkit_installed_test name folder)
    cmake_parse_arguments(arg "" "" "OPTIONS;COMMAND" ${ARGN})
    add_test(NAME ${name} COMMAND ${CMAKE_CTEST_COMMAND}
        --build-and-test ${folder} ${PRTKIT_TESTS_BINARY_DIR}/${name}
        --build-generator ${CMAKE_GENERATOR} --build-options -DCMAKE_PREFIX_PATH=${installed} ${arg_OPTIONS}
        --test-command ${arg_COMMAND})
    set_tests_properties(${name} PROPERTIES FIXTURES_REQUIRED "installed;models")
endfunction()
set(package ${PROJECT_SOURCE_DIR}/tests/package)
prtkit_installed_test(use_installed_package ${package} COMMAND package_user)
# A game that loads a model needs none of these packages.
list(TRANSFORM hidden_packages REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=ON")
prtkit_installed_test(game_that_loads_a_model ${package}/loader OPTIONS ${hidden_packages}
    COMMAND loader ${PRTKIT_FIXTURES}/knot.shipped.glb)
prtkit_installed_test(game ${PROJECT_SOURCE_DIR}/examples/game
    COMMAND game ${PRTKIT_FIXTURES}/knot.shipped.glb ${PRTKIT_FIXTURES}/sky.exr ${PRTKIT_TESTS_BINARY_DIR}/game.png 3)
if(TARGET prt-viewer)
    add_test(NAME installed_viewer COMMAND ${installed}/${CMAKE_INSTALL_BINDIR}/prt-viewer --help)
    set_tests_properties(installed_viewer PROPERTIES FIXTURES_REQUIRED installed)
endif()
# pkg-config alone, for C and for C++.
add_test(NAME use_pkg_config COMMAND ${package}/pkg_config.sh
    ${CMAKE_C_COMPILER} ${CMAKE_CXX_COMPILER} ${installed}/${CMAKE_INSTALL_LIBDIR} ${PROJECT_SOURCE_DIR}/tests
    ${PRTKIT_FIXTURES}/knot.shipped.glb ${PRTKIT_FIXTURES}/sky.exr)
set_tests_properties(use_pkg_config PROPERTIES FIXTURES_REQUIRED "installed;models")
