/// Mitsuba 3's grid volumes: "VOL", version 3, the type of the values (1: float), the numbers of samples
/// along x, y and z, the number of channels, the box from the first to the last samples, and the samples, x
/// fastest; little-endian throughout.
#include <bit>
#include <cstring>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "base/file.h"
#include "formats/grids.h"

namespace alhazen {

namespace {

static_assert(std::endian::native == std::endian::little, "written for little-endian machines");

constexpr std::size_t header_bytes = 48;
constexpr std::int32_t largest_side = 1 << 15;

template <class T>
T read_at(const std::string& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

template <class T>
void append(std::string& bytes, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

Vec3i read_header(const std::string& bytes, Vec3& lo, Vec3& hi) {
    if (bytes.size() < header_bytes || bytes.compare(0, 3, "VOL") != 0)
        throw std::runtime_error("not a .vol file: it does not begin with \"VOL\"");
    if (bytes[3] != 3) throw std::runtime_error(fmt::format("version {} of .vol; expected 3", int{bytes[3]}));
    if (auto type = read_at<std::int32_t>(bytes, 4); type != 1)
        throw std::runtime_error(fmt::format("values of type {}; expected 1, which are floats", type));
    Vec3i n{read_at<std::int32_t>(bytes, 8), read_at<std::int32_t>(bytes, 12),
            read_at<std::int32_t>(bytes, 16)};
    if (auto channels = read_at<std::int32_t>(bytes, 20); channels != 1)
        throw std::runtime_error(fmt::format("{} channels; expected one, the distance", channels));
    for (int i = 0; i < 3; ++i) {
        if (n[i] < 2 || n[i] > largest_side)
            throw std::runtime_error(
                fmt::format("{} samples along {}; expected 2 to {}", n[i], "xyz"[i], largest_side));
        lo[i] = read_at<float>(bytes, 24 + 4 * static_cast<std::size_t>(i));
        hi[i] = read_at<float>(bytes, 36 + 4 * static_cast<std::size_t>(i));
    }
    if (!is_finite(lo) || !is_finite(hi) || !(lo.x < hi.x) || !(lo.y < hi.y) || !(lo.z < hi.z))
        throw std::runtime_error("its bounding box is empty");
    return n;
}

std::size_t count_of(Vec3i n) {
    return static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z);
}

} // namespace

GridData read_vol(const std::filesystem::path& file) {
    std::string bytes = read_file(file);
    Vec3 lo, hi;
    Vec3i n = read_header(bytes, lo, hi);
    if (bytes.size() != header_bytes + 4 * count_of(n))
        throw std::runtime_error(fmt::format("{} bytes for {} x {} x {} values; expected {}", bytes.size(),
                                             n.x, n.y, n.z, header_bytes + 4 * count_of(n)));
    GridData data;
    data.hi = n - Vec3i{1, 1, 1};
    Vec3d spacing;
    for (int i = 0; i < 3; ++i)
        spacing[i] = (static_cast<double>(hi[i]) - static_cast<double>(lo[i])) / (n[i] - 1);
    data.object_from_index = Matrix4::translate(Vec3d(lo)) * Matrix4::scale(spacing);
    for (int bz = 0; bz < n.z; bz += GridBrick::size)
        for (int by = 0; by < n.y; by += GridBrick::size)
            for (int bx = 0; bx < n.x; bx += GridBrick::size) {
                GridBrick& brick = data.bricks.emplace_back();
                brick.origin = {bx, by, bz};
                for (int i = 0; i < static_cast<int>(GridBrick::samples); ++i) {
                    int x = std::min(bx + (i & 7), n.x - 1), y = std::min(by + (i >> 3 & 7), n.y - 1),
                        z = std::min(bz + (i >> 6), n.z - 1);
                    std::size_t at = static_cast<std::size_t>(x) +
                                     static_cast<std::size_t>(n.x) *
                                         (static_cast<std::size_t>(y) +
                                          static_cast<std::size_t>(n.y) * static_cast<std::size_t>(z));
                    auto value = read_at<float>(bytes, header_bytes + 4 * at);
                    if (!std::isfinite(value))
                        throw std::runtime_error(
                            fmt::format("the value at {}, {}, {} is not a finite number", x, y, z));
                    brick.values[static_cast<std::size_t>(i)] = value;
                }
            }
    return data;
}

void write_vol(const std::filesystem::path& file, const GridData& data) {
    Vec3i n = data.hi - data.lo + Vec3i{1, 1, 1};
    std::map<std::tuple<int, int, int>, const GridBrick*> bricks;
    for (const GridBrick& b : data.bricks) bricks[{b.origin.x, b.origin.y, b.origin.z}] = &b;
    std::string bytes = "VOL\3";
    bytes.reserve(header_bytes + 4 * count_of(n));
    for (std::int32_t v : {1, n.x, n.y, n.z, 1}) append(bytes, v);
    for (Vec3i corner : {data.lo, data.hi}) {
        Vec3d p = data.object_from_index.point(Vec3d(corner));
        for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(p[i]));
    }
    for (int z = data.lo.z; z <= data.hi.z; ++z)
        for (int y = data.lo.y; y <= data.hi.y; ++y)
            for (int x = data.lo.x; x <= data.hi.x; ++x) {
                auto it = bricks.find({brick_origin(x), brick_origin(y), brick_origin(z)});
                if (it == bricks.end()) throw std::runtime_error("a .vol file cannot leave samples out");
                append(bytes, it->second->values[GridBrick::at(x & 7, y & 7, z & 7)]);
            }
    write_file(file, bytes);
}

} // namespace alhazen
