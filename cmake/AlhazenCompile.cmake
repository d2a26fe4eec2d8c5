# The flags every target is compiled with: all warnings are errors, and results do not depend on the machine
# (no contraction into fused multiply-add, no fast-math).
add_library(alhazen_compile INTERFACE)
target_compile_features(alhazen_compile INTERFACE cxx_std_20)
target_compile_options(alhazen_compile INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -ffp-contract=off -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc 12 reports false positives of these two in inlined standard library code.
    target_compile_options(alhazen_compile INTERFACE -fcoroutines -Wno-maybe-uninitialized -Wno-restrict)
endif()
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
