# Compiler settings that everything of prtkit shares.
add_library(prtkit_settings INTERFACE)
target_compile_features(prtkit_settings INTERFACE cxx_std_20)
target_compile_options(prtkit_settings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    -Wno-psabi     # vectors never cross a library's border
    # -Wconversion as GCC has it; vectors may be loaded at float's alignment and passed by value.
    "$<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion;-Wno-align-mismatch>"
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>) # GCC 12 warns of its own std::string (bug 105651)
# Hot files get -O3 in their own CMakeLists; elsewhere -O3 only doubles the code. GCC collects garbage less often: a tenth
# less time for a quarter more memory.
target_compile_options(prtkit_settings INTERFACE $<$<CONFIG:Release>:-O2>
    "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-expand=300>"
    "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=1000000>")
if(NOT PRTKIT_CLONES)
    target_compile_definitions(prtkit_settings INTERFACE PRTKIT_NO_CLONES)
endif()
if(PRTKIT_WERROR)
    target_compile_options(prtkit_settings INTERFACE -Werror)
endif()

# For what takes longer to build than it runs: libraries without inner loops, tests, and prt, whose CLI11 takes a minute to
# optimise. With debug information it is not optimised: clang takes twice as long to optimise what sanitizers insert (one
# joined source of prt::gltf: 38 s of CPU at -O1, 18 s at -O0).
add_library(prtkit_cold INTERFACE)
target_compile_options(prtkit_cold INTERFACE $<$<CONFIG:Release>:-O1> $<$<CONFIG:RelWithDebInfo>:-O0>)

# For libraries that are inner loops all over: prt compress takes an eighth longer at -O2.
add_library(prtkit_hot INTERFACE)
target_compile_options(prtkit_hot INTERFACE $<$<CONFIG:Release>:-O3>)

# prtkit_library(<target> <name> [COLD | HOT]): gives a library its public headers, its alias prt::<name> and its export
# name. COLD, HOT: see prtkit_cold, prtkit_hot.
function(prtkit_library target name)
    cmake_parse_arguments(arg "COLD;HOT" "" "" ${ARGN})
    add_library(prt::${name} ALIAS ${target})
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:prtkit_settings>)
    if(arg_COLD)
        target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:prtkit_cold>)
    elseif(arg_HOT)
        target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:prtkit_hot>)
    endif()
    target_include_directories(${target}
        PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>
        PRIVATE ${PROJECT_SOURCE_DIR})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
    set_property(GLOBAL APPEND PROPERTY PRTKIT_LIBRARIES ${target})
    set_property(GLOBAL APPEND PROPERTY PRTKIT_HEADER_FOLDERS ${CMAKE_CURRENT_SOURCE_DIR}/include/)
endfunction()
