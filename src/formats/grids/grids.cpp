#include "formats/grids.h"

#include <fmt/format.h>

namespace alhazen {

std::string grid_suffix(const std::filesystem::path& file) {
    std::string suffix = file.extension().string();
    for (char& c : suffix) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    return suffix;
}

std::vector<std::string> grid_suffixes() {
    if (has_nanovdb()) return {".vol", ".nvdb"};
    return {".vol"};
}

GridData read_grid(const std::filesystem::path& file, const std::string& grid) {
    std::string suffix = grid_suffix(file);
    if (suffix == ".nvdb") return read_nvdb(file, grid);
    if (suffix == ".vdb")
        throw std::runtime_error(".vdb files are not read; nanovdb_convert makes .nvdb files of them");
    if (suffix != ".vol")
        throw std::runtime_error(fmt::format("unknown suffix \"{}\"; expected .vol or .nvdb", suffix));
    if (!grid.empty()) throw std::runtime_error("a .vol file holds one grid, which has no name");
    return read_vol(file);
}

void write_grid(const std::filesystem::path& file, const GridData& data) {
    if (grid_suffix(file) == ".nvdb")
        write_nvdb(file, data);
    else
        write_vol(file, data);
}

} // namespace alhazen
