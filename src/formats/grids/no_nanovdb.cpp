/// In builds without NanoVDB.
#include <stdexcept>

#include "formats/grids.h"

namespace alhazen {

namespace {

constexpr const char* missing = ".nvdb files need NanoVDB, without which this program was built (package "
                                "libnanovdb-dev); .vol files work";

} // namespace

bool has_nanovdb() {
    return false;
}
GridData read_nvdb(const std::filesystem::path&, const std::string&) {
    throw std::runtime_error(missing);
}
void write_nvdb(const std::filesystem::path&, const GridData&) {
    throw std::runtime_error(missing);
}

} // namespace alhazen
