# alhazen_precompile(TARGET): the standard library's headers, which are most of what a source file makes the compiler
# read, precompiled once and shared by all rooms.
function(alhazen_precompile target)
    if(target STREQUAL alhazen_base)
        target_precompile_headers(${target} PRIVATE
            <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <mutex> <optional> <span> <string>
            <string_view> <unordered_map> <variant> <vector> <fmt/format.h>)
    else()
        target_precompile_headers(${target} REUSE_FROM alhazen_base)
    endif()
endfunction()

# alhazen_room(NAME SEES room... LIBRARIES target...)
# One library a folder of src/. SEES names the rooms it may include from: the layers of the house, checked by
# tools/check_layers.
function(alhazen_room name)
    cmake_parse_arguments(ROOM "" "" "SEES;LIBRARIES;PRIVATE" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
    set(links "")
    foreach(room IN LISTS ROOM_SEES)
        list(APPEND links alhazen_${room})
    endforeach()
    if(sources)
        add_library(alhazen_${name} STATIC ${sources})
        set(scope PUBLIC)
        target_link_libraries(alhazen_${name} PRIVATE ${ROOM_PRIVATE})
        alhazen_precompile(alhazen_${name})
    else()
        add_library(alhazen_${name} INTERFACE)
        set(scope INTERFACE)
    endif()
    target_include_directories(alhazen_${name} ${scope} ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(alhazen_${name} ${scope} alhazen_compile ${links} ${ROOM_LIBRARIES})
endfunction()
