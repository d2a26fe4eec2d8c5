/// NanoVDB's files (Museth 2021, "NanoVDB: A GPU-Friendly and Portable VDB Data Structure"), through its
/// library.
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>

#include "base/file.h"
#include "formats/grids.h"

namespace alhazen {

namespace {

void add_sample_range(GridData& data) {
    if (data.bricks.empty()) throw std::runtime_error("it holds no values");
    constexpr int last = GridBrick::size - 1;
    data.lo = data.hi = data.bricks.front().origin;
    for (const GridBrick& b : data.bricks)
        for (int i = 0; i < 3; ++i) {
            data.lo[i] = std::min(data.lo[i], b.origin[i]);
            data.hi[i] = std::max(data.hi[i], b.origin[i] + last);
        }
    // The whole range is indexed by bricks.
    constexpr int largest_side = 1 << 14;
    for (int i = 0; i < 3; ++i)
        if (data.hi[i] - data.lo[i] > largest_side)
            throw std::runtime_error(fmt::format("its values are spread over more than {} samples along {}",
                                                 largest_side, "xyz"[i]));
    for (const GridBrick& b : data.bricks)
        for (float v : b.values)
            if (!std::isfinite(v)) throw std::runtime_error("it holds values that are not finite numbers");
}

/// Blocks of one value that the nodes of a level hold, as bricks.
template <int level>
void add_tiles(const nanovdb::NanoGrid<float>& grid, GridData& data) {
    constexpr std::size_t most_bricks = std::size_t{1} << 22; // 8 GB
    const auto* node = grid.tree().getFirstNode<level>();
    using Node = std::remove_cvref_t<decltype(*node)>;
    constexpr int side = static_cast<int>(Node::ChildNodeType::DIM);
    for (std::uint32_t k = 0; k < grid.tree().nodeCount(level); ++k, ++node)
        for (std::uint32_t n = 0; n < Node::SIZE; ++n) {
            if (node->childMask().isOn(n)) continue;
            const nanovdb::Coord o = node->offsetToGlobalCoord(n);
            const float value = grid.tree().getValue(o);
            if (value == grid.tree().background()) continue;
            for (int z = 0; z < side; z += GridBrick::size)
                for (int y = 0; y < side; y += GridBrick::size)
                    for (int x = 0; x < side; x += GridBrick::size) {
                        if (data.bricks.size() >= most_bricks)
                            throw std::runtime_error("its filled blocks take more memory than 8 GB");
                        GridBrick& b = data.bricks.emplace_back();
                        b.origin = {o.x() + x, o.y() + y, o.z() + z};
                        b.values.fill(value);
                    }
        }
}

GridData from_nanovdb(const nanovdb::NanoGrid<float>& grid) {
    GridData data;
    data.background = std::abs(grid.tree().background());
    data.is_level_set = !grid.isFogVolume();
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) data.object_from_index.m[i][j] = grid.map().mMatD[3 * i + j];
        data.object_from_index.m[i][3] = grid.map().mVecD[i];
    }
    if (!data.object_from_index.inverse()) throw std::runtime_error("its transformation cannot be inverted");
    static_assert(nanovdb::NanoLeaf<float>::DIM == GridBrick::size);
    const auto* leaf = grid.tree().getFirstNode<0>();
    for (std::uint32_t k = 0; k < grid.tree().nodeCount(0); ++k, ++leaf) {
        GridBrick& b = data.bricks.emplace_back();
        nanovdb::Coord o = leaf->origin();
        b.origin = {o.x(), o.y(), o.z()};
        for (int z = 0; z < 8; ++z)
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x)
                    b.values[GridBrick::at(x, y, z)] = leaf->getValue(nanovdb::Coord(x, y, z));
    }
    // In a level set tiles are deep inside or far outside; elsewhere they are blocks of one value.
    if (!data.is_level_set) {
        add_tiles<1>(grid, data);
        add_tiles<2>(grid, data);
    }
    return data;
}

void set_active_range(const nanovdb::NanoGrid<float>& grid, GridData& data) {
    const nanovdb::CoordBBox box = grid.indexBBox();
    for (unsigned axis = 0; axis < 3; ++axis) {
        const int i = static_cast<int>(axis);
        data.lo[i] = std::max(data.lo[i], box.min()[axis]);
        data.hi[i] = std::min(data.hi[i], box.max()[axis]);
        if (data.lo[i] > data.hi[i]) throw std::runtime_error("it holds no values");
    }
}

std::string names_text(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
    return text;
}

} // namespace

bool has_nanovdb() {
    return true;
}

GridData read_nvdb(const std::filesystem::path& file, const std::string& grid) {
    if (!std::filesystem::exists(file)) throw std::runtime_error("no such file");
    std::vector<std::string> names;
    auto metas = nanovdb::io::readGridMetaData(file.string());
    for (std::size_t i = 0; i < metas.size(); ++i) {
        names.push_back(metas[i].gridName);
        if (!grid.empty() && metas[i].gridName != grid) continue;
        auto handle = nanovdb::io::readGrid(file.string(), static_cast<std::uint64_t>(i));
        if (const auto* found = handle.grid<float>()) {
            if (!nanovdb::isValid(*found, true)) throw std::runtime_error("damaged: its checksum is wrong");
            GridData data = from_nanovdb(*found);
            add_sample_range(data);
            if (!data.is_level_set) set_active_range(*found, data);
            return data;
        }
    }
    if (grid.empty()) throw std::runtime_error("it holds no grid of floats");
    throw NoSuchGrid(fmt::format("no grid of floats is named \"{}\"; there are {}", grid, names_text(names)));
}

void write_nvdb(const std::filesystem::path& file, const GridData& data) {
    const auto& m = data.object_from_index.m;
    double spacing = m[0][0];
    Vec3d origin{m[0][3], m[1][3], m[2][3]};
    if (!(data.object_from_index == Matrix4::translate(origin) * Matrix4::scale(Vec3d(spacing))))
        throw std::runtime_error("a .nvdb file is written with cubic cells along the axes only");
    nanovdb::GridBuilder<float> builder(data.background, nanovdb::GridClass::LevelSet);
    auto accessor = builder.getAccessor();
    for (const GridBrick& b : data.bricks)
        for (int z = 0; z < 8; ++z)
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x) {
                    float v = std::clamp(b.values[GridBrick::at(x, y, z)], -data.background, data.background);
                    accessor.setValue(nanovdb::Coord(b.origin.x + x, b.origin.y + y, b.origin.z + z), v);
                }
    // Bodies are solid: what is not stored has the sign of what encloses it.
    builder.sdfToLevelSet();
    auto handle = builder.getHandle<>(spacing, nanovdb::Vec3d(origin.x, origin.y, origin.z), "surface");
    write_atomically(file, [&](const std::filesystem::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        nanovdb::io::writeGrid(out, handle, nanovdb::io::Codec::ZIP);
        out.flush();
        if (!out) throw std::runtime_error("the disk is full, or the file cannot be written");
    });
}

} // namespace alhazen
