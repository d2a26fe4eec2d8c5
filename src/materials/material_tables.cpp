#include "materials/material_tables.h"

#include "base/file.h"

namespace alhazen {

std::shared_ptr<const MeasuredData> MaterialTables::measured(const std::filesystem::path& file,
                                                             ColorMode mode) {
    return measured_.get({real_path(file), mode}, [&] {
        auto data = std::make_shared<const MeasuredData>(TensorFile(read_file(file)), mode);
        ++made_;
        return data;
    });
}

std::shared_ptr<const DiffusionTable> MaterialTables::diffusion(float g, float eta) {
    return diffusion_.get({g, eta}, [&] {
        auto table = std::make_shared<const DiffusionTable>(g, eta);
        ++made_;
        return table;
    });
}

} // namespace alhazen
