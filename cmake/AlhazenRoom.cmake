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

# alhazen_unity(TARGET BATCH file...): compiles so many files of the target at once, but those named, which share names of
# their own with others.
function(alhazen_unity target batch)
    if(ALHAZEN_UNITY)
        set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
    endif()
endfunction()

# alhazen_room(NAME SEES room... LIBRARIES target... APART pattern...)
# One library a folder of src/. SEES names the rooms it may include from: the layers of the house, checked by
# tools/check_layers. APART: files that share names of their own with others, and are compiled by themselves always.
function(alhazen_room name)
    cmake_parse_arguments(ROOM "" "" "SEES;LIBRARIES;PRIVATE;APART" ${ARGN})
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
        list(TRANSFORM ROOM_APART PREPEND ${PROJECT_SOURCE_DIR}/src/${name}/)
        file(GLOB apart ${ROOM_APART})
        alhazen_unity(alhazen_${name} 8 ${apart})
    else()
        add_library(alhazen_${name} INTERFACE)
        set(scope INTERFACE)
    endif()
    target_include_directories(alhazen_${name} ${scope} ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(alhazen_${name} ${scope} alhazen_compile ${links} ${ROOM_LIBRARIES})
endfunction()
