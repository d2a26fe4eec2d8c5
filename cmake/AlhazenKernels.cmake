# The files of src/accel/wide that are compiled for instruction sets beyond the ordinary; the program chooses among them
# when it runs. They share nothing with the other files, the precompiled header included: see kernel.h. Their vectors are
# written by hand; compilers are told to add none.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
    set(kernel_flags_sse42 -msse4.2)
    set(kernel_flags_avx2 -mavx2 -mfma -mbmi -mbmi2 -mpopcnt)
    set(kernel_flags_avx512 ${kernel_flags_avx2} -mavx512f -mavx512vl -mavx512dq -mavx512bw -mprefer-vector-width=256)
endif()
foreach(set plain sse42 avx2 avx512)
    set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/accel/wide/kernel_${set}.cpp PROPERTIES
        SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "-fno-tree-vectorize;-fno-tree-slp-vectorize;${kernel_flags_${set}}")
endforeach()
# The rasteriser's, those that follow bundles of rays, and those that march through distances, whose text leaves it to
# the compiler to put lanes into registers.
foreach(folder raster integrators/bundle scene/march)
    set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/${folder}/kernel_plain.cpp PROPERTIES
        SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "-Wno-psabi")
    foreach(set avx2 avx512)
        set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/${folder}/kernel_${set}.cpp PROPERTIES
            SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "-Wno-psabi;${kernel_flags_${set}}")
    endforeach()
endforeach()
