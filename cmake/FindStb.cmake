# stb has no CMake or pkg-config file in every distribution; its headers are in a folder of that name.
find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Stb REQUIRED_VARS STB_INCLUDE_DIR)
if(Stb_FOUND AND NOT TARGET Stb::stb)
    add_library(Stb::stb INTERFACE IMPORTED)
    set_target_properties(Stb::stb PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${STB_INCLUDE_DIR}"
                                              INTERFACE_INCLUDE_DIRECTORIES "${STB_INCLUDE_DIR}")
endif()
