# prt_tests(<name> SOURCES <file>... LIBRARIES <target>... [OPENGL]): a test program. ctest knows one test per suite,
# `<name>/<suite>`: one process runs all tests of a suite, so that SetUpTestSuite pays. The tests of a suite that match
# `long_tests` (long_tests.cmake) form a test of their own, `<name>/<suite>/long`, with the label `long`.
# OPENGL: do not look for leaks. The software driver keeps memory until the process ends and is unloaded by then, so its
# leaks cannot be told from ours; the same code without OpenGL is checked.
function(prt_tests name)
    cmake_parse_arguments(arg "OPENGL" "" "SOURCES;LIBRARIES" ${ARGN})
    add_executable(${name} ${arg_SOURCES})
    target_link_libraries(${name} PRIVATE test_support ${arg_LIBRARIES})
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PRTKIT_TESTS_BINARY_DIR})
    set(environment "")
    if(arg_OPENGL)
        set(environment "ASAN_OPTIONS=detect_leaks=0")
    endif()
    set(suites ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
    add_custom_command(TARGET ${name} POST_BUILD
        COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}> -DNAME=${name} "-DLONG_TESTS=${long_tests}"
            -DENVIRONMENT=${environment} -DOUTPUT=${suites} -P ${PROJECT_SOURCE_DIR}/tests/add_suites.cmake
        BYPRODUCTS ${suites} VERBATIM)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake "if(EXISTS \"${suites}\")
    include(\"${suites}\")
else()
    add_test(${name}_is_not_built ${name}_is_not_built)
endif()
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake)
endfunction()
