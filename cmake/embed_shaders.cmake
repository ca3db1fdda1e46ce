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
    prtkit_embed_files(${target} FUNCTION embedded_files HEADER embedded_files.h FILES ${ARGN})
endfunction()
