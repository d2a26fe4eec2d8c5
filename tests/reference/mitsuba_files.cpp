#include "tests/reference/mitsuba_files.h"

#include <array>
#include <cstring>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "base/file.h"
#include "image/codec.h"
#include "tests/reference/mitsuba_slides.h"

namespace alhazen::testing {

namespace fs = std::filesystem;

namespace {

/// A mesh of triangles whose corners have a place, texture coordinates and perhaps a normal.
struct ObjMesh {
    std::vector<std::array<float, 3>> places, normals;
    std::vector<std::array<float, 2>> uvs;
    std::vector<std::array<int, 3>> corners; ///< indices of each, from 0; of the normal -1 if there is none
    std::vector<std::array<std::size_t, 3>> triangles;
};

template <std::size_t N>
std::array<float, N> numbers(std::istream& in) {
    std::array<float, N> values{};
    for (float& v : values) in >> v;
    return values;
}

ObjMesh read_obj(const fs::path& file) {
    ObjMesh mesh;
    std::map<std::array<int, 3>, std::size_t> known;
    std::istringstream lines(read_file(file));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream in(line);
        std::string word;
        in >> word;
        if (word == "v") mesh.places.push_back(numbers<3>(in));
        if (word == "vn") mesh.normals.push_back(numbers<3>(in));
        if (word == "vt") mesh.uvs.push_back(numbers<2>(in));
        if (word != "f") continue;
        std::array<std::size_t, 3> triangle{};
        for (std::size_t& t : triangle) {
            std::string text;
            in >> text;
            std::array<int, 3> corner{};
            const int read = std::sscanf(text.c_str(), "%d/%d/%d", &corner[0], &corner[1], &corner[2]);
            if (read < 2) throw std::runtime_error(fmt::format("{}: \"{}\"", file.string(), line));
            for (int& index : corner) --index;
            const auto [found, is_new] = known.try_emplace(corner, mesh.corners.size());
            if (is_new) mesh.corners.push_back(corner);
            t = found->second;
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

std::string as_ply(const ObjMesh& mesh) {
    const bool has_normals = !mesh.normals.empty();
    std::string text = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\n", mesh.corners.size());
    for (const char* name : {"x", "y", "z"}) text += fmt::format("property float {}\n", name);
    if (has_normals)
        for (const char* name : {"nx", "ny", "nz"}) text += fmt::format("property float {}\n", name);
    text += "property float u\nproperty float v\n";
    text += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                        mesh.triangles.size());
    for (const auto& corner : mesh.corners) {
        const auto& p = mesh.places.at(static_cast<std::size_t>(corner[0]));
        const auto& uv = mesh.uvs.at(static_cast<std::size_t>(corner[1]));
        text += fmt::format("{} {} {}", p[0], p[1], p[2]);
        if (has_normals) {
            const auto& n = mesh.normals.at(static_cast<std::size_t>(corner[2]));
            text += fmt::format(" {} {} {}", n[0], n[1], n[2]);
        }
        text += fmt::format(" {} {}\n", uv[0], uv[1]);
    }
    for (const auto& t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
    return text;
}

Image enlarged_sky(const Image& image) {
    constexpr int factor = 4;
    const int w = image.width(), h = image.height();
    Image large = Image::rgb_image(factor * w, factor * h);
    for (int y = 0; y < large.height(); ++y)
        for (int x = 0; x < large.width(); ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / factor - 0.5f,
                        v = (static_cast<float>(y) + 0.5f) / static_cast<float>(large.height()) *
                            static_cast<float>(h - 1);
            const auto left = static_cast<int>(std::floor(u)), top = std::min(static_cast<int>(v), h - 2);
            auto blend = [&](int row) {
                const float t = u - static_cast<float>(left);
                return image.rgb((left + w) % w, row) * (1 - t) + image.rgb((left + 1) % w, row) * t;
            };
            const float t = v - static_cast<float>(top);
            large.set_rgb(x, y, blend(top) * (1 - t) + blend(top + 1) * t);
        }
    return large;
}

Image without_alpha(const Image& image) {
    std::vector<std::string> names = image.channel_names();
    std::erase(names, "A");
    return image.select(names);
}

/// Mitsuba's .vol: "VOL", version, type, size, channels, a box, floats with x running fastest.
std::string grid_attributes(const fs::path& file) {
    const std::string bytes = read_file(file);
    std::array<std::int32_t, 5> head{}; // type, size in x y z, channels
    constexpr std::size_t values_at = 4 + sizeof head + 6 * sizeof(float);
    if (bytes.size() < values_at || !bytes.starts_with("VOL\3"))
        throw std::runtime_error(fmt::format("{}: not a grid", file.string()));
    std::memcpy(head.data(), bytes.data() + 4, sizeof head);
    const int nx = head[1], ny = head[2], nz = head[3], channels = head[4];
    std::vector<float> values((bytes.size() - values_at) / sizeof(float));
    std::memcpy(values.data(), bytes.data() + values_at, values.size() * sizeof(float));

    auto list = [&](float factor) {
        std::string text;
        for (int z = -1; z <= nz; ++z)
            for (int y = -1; y <= ny; ++y)
                for (int x = -1; x <= nx; ++x)
                    for (int c = 0; c < channels; ++c) {
                        const int cell = (std::clamp(z, 0, nz - 1) * ny + std::clamp(y, 0, ny - 1)) * nx +
                                         std::clamp(x, 0, nx - 1);
                        text += fmt::format(
                            "{} ", factor * values.at(static_cast<std::size_t>(cell * channels + c)));
                    }
        return text;
    };
    std::string text = fmt::format(
        "Attribute \"medium\" \"integer nx\" {} \"integer ny\" {} \"integer nz\" {}\n"
        "    \"point3 p0\" [ {} {} {} ] \"point3 p1\" [ {} {} {} ]\n",
        nx + 2, ny + 2, nz + 2, -1.0 / nx, -1.0 / ny, -1.0 / nz, 1 + 1.0 / nx, 1 + 1.0 / ny, 1 + 1.0 / nz);
    if (channels == 1) return text + fmt::format("    \"float density\" [ {}]\n", list(1));
    return text +
           fmt::format("    \"rgb sigma_a\" [ {}]\n    \"rgb sigma_s\" [ {}]\n", list(0.01f), list(0.99f));
}

class SceneCopy {
  public:
    SceneCopy(fs::path from, const fs::path& shared, fs::path to, ColorMode mode)
        : from_(std::move(from)), to_(std::move(to)), mode_(mode),
          places_{shared / "common/meshes", shared / "common/textures",
                  shared / "tests/scenes/participating_media/meshes",
                  shared / "tests/scenes/participating_media/textures"} {}

    void copy(const std::string& name) {
        if (!done_.insert(name).second) return;
        const fs::path path(name);
        if (fs::exists(from_ / name)) {
            copy_scene(name);
        } else if (path.extension() == ".pbrt") {
            std::string stem = path.stem().string();
            stem.erase(stem.rfind("_grid"));
            write_file(to_ / name, grid_attributes(find(stem + ".vol")));
        } else if (path.extension() == ".ply") {
            write_file(to_ / name, as_ply(read_obj(find(path.stem().string() + ".obj"))));
        } else if (path.extension() == ".exr") {
            WriteOptions options;
            options.depth = FloatDepth::single;
            write_image(to_ / name, light_picture(path.stem().string()), options);
        } else {
            write_image(to_ / name, without_alpha(read_image(find(name))));
        }
    }

  private:
    void copy_scene(const std::string& name) {
        const std::string text = read_file(from_ / name);
        write_file(to_ / name, text);
        static const std::regex file_name("\"([a-z_]+\\.[a-z]+)\"");
        for (auto i = std::sregex_iterator(text.begin(), text.end(), file_name); i != std::sregex_iterator();
             ++i)
            copy((*i)[1].str());
    }

    Image light_picture(const std::string& stem) const {
        auto picture = [&](std::string_view what) {
            return read_image(find(stem.substr(0, stem.size() - what.size()) + ".bmp"));
        };
        auto shining = [&](std::string_view what) {
            return mode_ == ColorMode::rgb ? picture(what) : in_even_light(picture(what));
        };
        if (stem == "white_spot") return spot_slide({});
        if (stem.ends_with("_spot")) return spot_slide(picture("_spot"));
        if (stem.ends_with("_projector")) return projector_slide(shining("_projector"));
        if (stem.ends_with("_panel")) return panel_picture(shining("_panel"));
        return enlarged_sky(read_image(find(stem + ".exr")));
    }

    fs::path find(const std::string& name) const {
        for (const fs::path& place : places_)
            if (fs::exists(place / name)) return place / name;
        throw std::runtime_error(fmt::format("no file \"{}\" among Mitsuba's", name));
    }

    fs::path from_, to_;
    ColorMode mode_;
    std::array<fs::path, 4> places_;
    std::set<std::string> done_;
};

} // namespace

fs::path copy_mitsuba_scene(const fs::path& scene, const fs::path& shared, const fs::path& folder,
                            ColorMode mode) {
    fs::create_directories(folder);
    SceneCopy(scene.parent_path(), shared, folder, mode).copy(scene.filename().string());
    return folder / scene.filename();
}

} // namespace alhazen::testing
