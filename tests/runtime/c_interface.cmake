# The C interface on a shipped model, from a program in C, and from one that loads and unloads the library.
if(NOT TARGET prt OR NOT TARGET example_scenes)
    return()
endif()
add_executable(c_tests c/c_test.c)
set_target_properties(c_tests PROPERTIES C_STANDARD 11)
add_dependencies(gate c_tests)
if(PRTKIT_SANITIZED) # clang's runtime for C++, which prt::c contains
    set_target_properties(c_tests PROPERTIES LINKER_LANGUAGE CXX)
endif()
target_link_libraries(c_tests PRIVATE prt::c $<$<PLATFORM_ID:Linux>:m>)
add_test(NAME c_interface COMMAND c_tests ${PRTKIT_FIXTURES}/knot.shipped.glb ${PRTKIT_FIXTURES}/sky.exr)
set_tests_properties(c_interface PROPERTIES FIXTURES_REQUIRED models)
if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
    find_program(GNU_NM nm REQUIRED) # that of LLVM 14 prints no versions
    add_test(NAME c_library_keeps_its_symbols COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/c/check_symbols.sh ${GNU_NM}
        $<TARGET_FILE:prt_c> ${CMAKE_CURRENT_SOURCE_DIR}/c/symbols.txt
        ${PROJECT_SOURCE_DIR}/runtime/c/include/prt/prt.h)
endif()
if(UNIX AND NOT PRTKIT_SANITIZED) # sanitizers keep libraries loaded
    add_executable(unload_tests c/unload_test.c)
    target_include_directories(unload_tests PRIVATE
        ${PROJECT_SOURCE_DIR}/runtime/c/include ${PROJECT_SOURCE_DIR}/runtime/include)
    target_link_libraries(unload_tests PRIVATE ${CMAKE_DL_LIBS})
    add_dependencies(unload_tests prt_c) # loaded, not linked
    add_test(NAME c_library_unloads COMMAND unload_tests $<TARGET_FILE:prt_c> ${PRTKIT_FIXTURES}/knot.shipped.glb)
    set_tests_properties(c_library_unloads PROPERTIES FIXTURES_REQUIRED models)
endif()
