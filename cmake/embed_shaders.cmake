# prtkit_embed_files(<target> FUNCTION <name> HEADER <file> FILES <file>...): makes files part of a target, as
# prt::<name>(), which HEADER declares.
function(prtkit_embed_files target)
    cmake_parse_arguments(arg "" "FUNCTION;HEADER" "FILES" ${ARGN})
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${arg_FUNCTION}.cpp)
    add_custom_command(OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${source} -DFUNCTION=${arg_FUNCTION} -DHEADER=${arg_HEADER} "-DFILES=${arg_FILES}"
            -P ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake
        DEPENDS ${arg_FILES} ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake VERBATIM)
    target_sources(${target} PRIVATE ${source})
endfunction()

# prtkit_embed_shaders(<target> <file>...): makes the GLSL files of shaders/ part of a library, as
# prt::embedded_files().
function(prtkit_embed_shaders target)
    list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/shaders/)
    prtkit_embed_files(${target} FUNCTION embedded_files HEADER runtime/shader/embedded_files.h FILES ${ARGN})
endfunction()

# prtkit_embed_kernels(<target> <name>...): compiles shaders/<name>.comp to SPIR-V for Vulkan 1.2 and makes it part of a
# target, as an array of words in the header kernels/<name>.h; <name>_query is <name> with the device's ray queries.
function(prtkit_embed_kernels target)
    find_program(PRTKIT_GLSLANG glslangValidator REQUIRED)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/kernels)
    file(MAKE_DIRECTORY ${folder})
    file(GLOB parts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/*.glsl ${PROJECT_SOURCE_DIR}/shaders/shared_*.h)
    foreach(name IN LISTS ARGN)
        string(REGEX REPLACE "_query$" "" kernel ${name})
        set(define "")
        if(NOT kernel STREQUAL name)
            set(define -DPRT_RAY_QUERY)
        endif()
        set(source ${PROJECT_SOURCE_DIR}/shaders/${kernel}.comp)
        add_custom_command(OUTPUT ${folder}/${name}.h
            COMMAND ${PRTKIT_GLSLANG} -V --quiet --target-env vulkan1.2 ${define} -I${PROJECT_SOURCE_DIR}/shaders
                --variable-name ${name} -o ${folder}/${name}.h ${source}
            DEPENDS ${source} ${parts} VERBATIM)
        target_sources(${target} PRIVATE ${folder}/${name}.h)
        list(APPEND headers ${folder}/${name}.h)
    endforeach()
    add_custom_target(${target}_kernels DEPENDS ${headers}) # for tools that read sources and build nothing
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
