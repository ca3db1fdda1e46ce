# prtkit_add_draco(<target>): makes Draco part of a static library, without its own reading and writing of glTF files.
# Debian's libdraco has a tinygltf of another layout and an stb inside. Linked as it is, in whatever order, these can stand
# in for the real ones; taken apart they are nowhere, and who links the library needs no Draco.
function(prtkit_add_draco target)
    find_package(draco REQUIRED)
    if(NOT TARGET draco::draco_static) # built without a static library, so without glTF as well
        target_link_libraries(${target} PRIVATE draco::draco)
        return()
    endif()
    get_target_property(archive draco::draco_static LOCATION)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/draco)
    file(MAKE_DIRECTORY ${folder})
    execute_process(COMMAND ${CMAKE_AR} x ${archive} WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
    file(GLOB objects ${folder}/*${CMAKE_CXX_OUTPUT_EXTENSION})
    list(FILTER objects EXCLUDE REGEX "gltf[^/]*$")
    target_sources(${target} PRIVATE ${objects})
    get_target_property(include draco::draco_static INTERFACE_INCLUDE_DIRECTORIES)
    target_include_directories(${target} SYSTEM PRIVATE ${include})
endfunction()
