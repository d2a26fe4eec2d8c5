# The flags every target is compiled with: all warnings are errors, and results do not depend on the machine
# (no contraction into fused multiply-add, no fast-math).
add_library(alhazen_compile INTERFACE)
target_compile_features(alhazen_compile INTERFACE cxx_std_20)
target_compile_options(alhazen_compile INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off -fno-math-errno)
# Warnings are errors with the compilers the project is checked with. Others may know warnings that nobody has seen;
# those must not keep a new user from building.
set(checked_compilers "GNU 12" "Clang 16")
string(REGEX MATCH "^[0-9]+" compiler_major "${CMAKE_CXX_COMPILER_VERSION}")
list(FIND checked_compilers "${CMAKE_CXX_COMPILER_ID} ${compiler_major}" checked)
option(ALHAZEN_WARNINGS_ARE_ERRORS "Stop at a warning, whatever the compiler" OFF)
if(ALHAZEN_WARNINGS_ARE_ERRORS OR NOT checked EQUAL -1)
    target_compile_options(alhazen_compile INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc 12 reports false positives of these in inlined standard library code.
    target_compile_options(alhazen_compile INTERFACE
        -fcoroutines -Wno-maybe-uninitialized -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread
        -Wno-array-bounds)
endif()
if(ALHAZEN_UNITY)
    # Each file by itself is free of these, which other builds check.
    target_compile_options(alhazen_compile INTERFACE -Wno-shadow)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(alhazen_compile INTERFACE -Wno-subobject-linkage)
    endif()
endif()
# Everyone formats text; linked here so that all rooms are compiled alike and can share one precompiled header.
target_link_libraries(alhazen_compile INTERFACE fmt::fmt)
if(ALHAZEN_SANITIZE)
    target_compile_options(alhazen_compile INTERFACE
        -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(alhazen_compile INTERFACE -fsanitize=address,undefined)
endif()
if(ALHAZEN_TSAN)
    target_compile_options(alhazen_compile INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
    target_link_options(alhazen_compile INTERFACE -fsanitize=thread)
endif()
if(ALHAZEN_COVERAGE)
    target_compile_options(alhazen_compile INTERFACE --coverage -fprofile-update=atomic)
    target_link_options(alhazen_compile INTERFACE --coverage)
endif()
