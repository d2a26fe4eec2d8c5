#include "formats/grids.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace alhazen {

namespace {

// As a shell takes it for one word.
std::string shell_word(const std::string& text) {
    auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view("/._-+,@%").find(c) != std::string_view::npos;
    };
    if (std::all_of(text.begin(), text.end(), is_plain)) return text;
    std::string word = "'";
    for (char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

// What is said of OpenVDB's files: how to have one that is read.
std::string openvdb_text(const std::filesystem::path& file) {
    std::filesystem::path made = file;
    made.replace_extension(".nvdb");
    return fmt::format(
        "it is an OpenVDB file, which is not read; a NanoVDB file is{}, and this command (Debian's "
        "package libnanovdb-tools) makes one of it: nanovdb_convert {} {}",
        has_nanovdb() ? "" : " by programs built with NanoVDB (package libnanovdb-dev)",
        shell_word(file.string()), shell_word(made.string()));
}

} // namespace

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
    if (suffix == ".vdb") throw std::runtime_error(openvdb_text(file));
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
