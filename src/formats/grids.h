/// Grid files: Mitsuba 3's volumes (.vol), and NanoVDB's level sets (.nvdb) where the program was built with
/// it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "describe/grid_file.h"

namespace alhazen {

/// Reads the grid of that name, or the first of numbers when grid is empty; .vol files have one grid without
/// a name. Throws std::runtime_error without the file's name.
GridData read_grid(const std::filesystem::path& file, const std::string& grid);

/// Writes under a temporary name, then renames. A .vol file needs all samples from lo to hi; in a .nvdb file
/// what is not stored gets its sign from what is. Throws std::runtime_error without the file's name.
void write_grid(const std::filesystem::path& file, const GridData& data);

/// Lower case, with the dot.
std::string grid_suffix(const std::filesystem::path& file);
/// What write_grid can write in this build: ".vol" ...
std::vector<std::string> grid_suffixes();

GridData read_vol(const std::filesystem::path& file);
void write_vol(const std::filesystem::path& file, const GridData& data);

/// Without NanoVDB the other two throw what to do about it.
bool has_nanovdb();
GridData read_nvdb(const std::filesystem::path& file, const std::string& grid);
void write_nvdb(const std::filesystem::path& file, const GridData& data);

} // namespace alhazen
