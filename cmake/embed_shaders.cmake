# prtkit_embed_shaders(<target> <file>...): makes the GLSL files of shaders/ part of a library, as
# prt::embedded_files().
function(prtkit_embed_shaders target)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_files.cpp)
    set(files)
    foreach(name ${ARGN})
        list(APPEND files ${PROJECT_SOURCE_DIR}/shaders/${name})
    endforeach()
    add_custom_command(OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${source} "-DFILES=${files}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake
        DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake VERBATIM)
    target_sources(${target} PRIVATE ${source})
endfunction()
