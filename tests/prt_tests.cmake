# prt_tests(<name> SOURCES <file>... LIBRARIES <target>... [FIXTURES <fixture>...] [OPENGL] [LONG] [ALONE]):
# adds a test program.
# ctest has one test per suite, `<name>/<suite>`: one process runs all tests of a suite, so that
# SetUpTestSuite runs once.
# The tests of a suite that match `long_tests` (long_tests.cmake) form a separate test, `<name>/<suite>/long`,
# with the label `long`.
# FIXTURES: fixtures that ctest sets up before.
# OPENGL: do not check for leaks. The software driver keeps memory until the process ends and is unloaded by
# then, so its leaks cannot be distinguished from ours; the code is also checked without OpenGL.
# LONG: all tests are long; the target `gate` does not build the program.
# ALONE: link GoogleTest, not test_support.
function(prt_tests name)
    cmake_parse_arguments(arg "OPENGL;LONG;ALONE" "" "SOURCES;LIBRARIES;FIXTURES" ${ARGN})
    add_executable(${name} ${arg_SOURCES})
    if(arg_ALONE)
        target_link_libraries(${name} PRIVATE GTest::gtest_main prtkit_settings prtkit_cold ${arg_LIBRARIES})
        target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR})
    else()
        target_link_libraries(${name} PRIVATE test_support ${arg_LIBRARIES})
        target_precompile_headers(${name} REUSE_FROM test_support)
    endif()
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PRTKIT_TESTS_BINARY_DIR})
    set(properties "")
    set(long ${long_tests})
    set(label unit)
    if(arg_OPENGL)
        list(APPEND properties ENVIRONMENT "ASAN_OPTIONS=detect_leaks=0")
    endif()
    if(arg_FIXTURES)
        list(JOIN arg_FIXTURES ":" fixtures)
        list(APPEND properties FIXTURES_REQUIRED ${fixtures})
    endif()
    if(arg_LONG)
        set(long "*")
        set(label long)
    else()
        add_dependencies(gate ${name})
    endif()
    set(suites ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
    add_custom_command(TARGET ${name} POST_BUILD
        COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}> -DNAME=${name} "-DLONG_TESTS=${long}"
            "-DPROPERTIES=${properties}" -DOUTPUT=${suites} -P ${PROJECT_SOURCE_DIR}/tests/add_suites.cmake
        BYPRODUCTS ${suites} VERBATIM)
    set(missing ${name}_is_not_built)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake "if(EXISTS \"${suites}\")
    include(\"${suites}\")
else()
    add_test(${missing} ${missing})
    set_tests_properties(${missing} PROPERTIES LABELS \"${label}\")
endif()
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake)
endfunction()
