/// bench_loading: how fast scenes are read, beside reading nothing but their bytes from the disk's cache. The
/// files are made for the occasion, in a new folder that is removed afterwards.
#include <cmath>
#include <cstdio>
#include <fstream>

#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/file.h"
#include "base/hash.h"
#include "formats/format.h"
#include "formats/ply.h"
#include "lab/timing.h"
#include "render/renderer.h"

namespace alhazen::bench {
namespace {

namespace fs = std::filesystem;

struct Arguments {
    fs::path folder = fs::temp_directory_path();
    std::size_t megabytes = 100;
    int side = 2237; ///< of the terrain's grid
    int repeat = 5;
};

const char* const view = R"(Film "rgb" "integer xresolution" 64 "integer yresolution" 64
LookAt 1100 -600 900  1100 1100 0  0 0 1
Camera "perspective" "float fov" 60
WorldBegin
Material "diffuse"
)";

/// A patch of hills of 4802 triangles, as text.
std::string hills(int number, Rng& rng) {
    constexpr int n = 50;
    std::string text = "Shape \"trianglemesh\" \"integer indices\" [";
    for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i) {
            const int a = j * n + i;
            fmt::format_to(std::back_inserter(text), " {} {} {} {} {} {}", a, a + 1, a + n, a + 1, a + n + 1,
                           a + n);
        }
    text += " ]\n    \"point3 P\" [";
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            fmt::format_to(std::back_inserter(text), " {} {} {:.6g}", i + 60 * (number % 40),
                           j + 60 * (number / 40), 3 * rng.uniform());
    return text + " ]\n";
}

/// A ball of its own colour, somewhere.
std::string ball(int number, Rng& rng) {
    return fmt::format(
        "AttributeBegin\n  Translate {} {} {}\n  Rotate {} 0 0 1\n  Material \"diffuse\" \"rgb "
        "reflectance\" [ {:.4f} {:.4f} {:.4f} ]\n  Shape \"sphere\" \"float radius\" {:.5f}\n"
        "AttributeEnd\n",
        number % 997, number / 997, number % 13, number % 360, rng.uniform(), rng.uniform(), rng.uniform(),
        0.1f + rng.uniform());
}

/// Pieces, one after another, until so many bytes are full.
template <class Piece>
std::string filled(std::size_t bytes, int& number, const Piece& piece) {
    Rng rng(static_cast<std::uint64_t>(number) + 1);
    std::string text;
    text.reserve(bytes + (std::size_t{1} << 20));
    while (text.size() < bytes) text += piece(number++, rng);
    return text;
}

/// A binary PLY file of a terrain of side x side vertices.
void write_terrain(const fs::path& file, int side) {
    const std::size_t vertices = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    const std::size_t cells = static_cast<std::size_t>(side - 1) * static_cast<std::size_t>(side - 1);
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
        "y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices, 2 * cells);
    auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const auto x = static_cast<float>(i), y = static_cast<float>(j);
            put(x), put(y), put(3 * std::sin(x * 0.05f) + 4 * std::cos(y * 0.033f));
        }
    for (int j = 0; j + 1 < side; ++j)
        for (int i = 0; i + 1 < side; ++i)
            for (const bool upper : {false, true}) {
                const int a = j * side + i, first = upper ? a + 1 : a;
                put(std::uint8_t{3}), put(first), put(upper ? a + side + 1 : a + 1), put(a + side);
            }
    write_file(file, bytes);
}

/// Reads the bytes, into the same little memory again and again.
void read_through(const fs::path& file) {
    std::vector<char> buffer(std::size_t{1} << 18);
    std::ifstream in(file, std::ios::binary);
    while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()))) continue;
}

/// How long work takes in a process of its own, as a program that reads one scene does it: the memory that
/// earlier work has freed would be there already, which is up to half of the time. The caller must not have
/// started threads.
double seconds_in_new_process(const std::function<void()>& work) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no new process");
    if (child == 0) {
        try {
            const double seconds = seconds_of(2, work);
            _exit(write(ends[1], &seconds, sizeof seconds) == sizeof seconds ? 0 : 2);
        } catch (const std::exception& e) {
            fmt::print(stderr, "bench_loading: error: {}\n", e.what());
            _exit(2);
        }
    }
    close(ends[1]);
    double seconds = 0;
    const bool is_told = read(ends[0], &seconds, sizeof seconds) == sizeof seconds;
    close(ends[0]);
    waitpid(child, nullptr, 0);
    if (!is_told) throw std::runtime_error("a scene was not read to its end");
    return seconds;
}

/// A folder of one's own inside another, as long as it lives.
class NewFolder {
  public:
    explicit NewFolder(const fs::path& parent)
        : path_(parent / fmt::format("alhazen-bench-loading-{}", getpid())) {
        if (!fs::create_directory(path_)) throw std::runtime_error(path_.string() + " is there already");
    }
    ~NewFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;

    fs::path operator/(const std::string& name) const { return path_ / name; }

  private:
    fs::path path_;
};

/// Reading alone and loading in turn.
void report(const std::string& name, const std::vector<fs::path>& files, int repeat,
            const std::function<void()>& load) {
    double megabytes = 0;
    for (const fs::path& file : files) megabytes += static_cast<double>(fs::file_size(file)) * 1e-6;
    std::vector<double> loads, ratios;
    for (int i = 0; i <= repeat; ++i) {
        const double reading = seconds_of(2, [&] {
            for (const fs::path& file : files) read_through(file);
        });
        const double loading = seconds_in_new_process(load);
        if (i == 0) continue; // the files may not be in the cache yet
        loads.push_back(loading);
        ratios.push_back(loading / reading);
    }
    fmt::print("{:<44}{:>6.0f} MB{:>8.3f} s{:>7.0f} MB/s{:>7.1f} times reading{:>7.2f}\n", name, megabytes,
               median_of(loads), megabytes / median_of(loads), median_of(ratios), spread_of(loads));
    std::fflush(stdout);
}

SceneDescription described(const fs::path& file) {
    Messages messages;
    SceneDescription scene = read_scene(file, messages);
    messages.throw_if_errors();
    return scene;
}

void run(const Arguments& a) {
    const NewFolder folder(a.folder);
    const std::size_t bytes = a.megabytes * 1000000;
    int number = 0;
    write_file(folder / "meshes.pbrt", view + filled(bytes, number, hills));
    number = 0;
    write_file(folder / "balls.pbrt", view + filled(bytes, number, ball));
    number = 0;
    std::string parts = view;
    std::vector<fs::path> files{folder / "parts.pbrt"};
    for (int part = 0; part < 8; ++part) {
        files.push_back(folder / fmt::format("part-{}.pbrt", part));
        write_file(files.back(), filled(bytes / 8, number, hills));
        parts += fmt::format("Import \"{}\"\n", files.back().filename().string());
    }
    write_file(files.front(), parts);
    write_terrain(folder / "terrain.ply", a.side);
    write_file(folder / "terrain.pbrt",
               std::string(view) + "Shape \"plymesh\" \"string filename\" \"terrain.ply\"\n");

    fmt::print("{:<44}{:>9}{:>10}{:>12}{:>21}{:>7}\n", "", "size", "median", "rate", "", "spread");
    report("text: meshes of 4802 triangles", {folder / "meshes.pbrt"}, a.repeat,
           [&] { described(folder / "meshes.pbrt"); });
    report("text: the same in eight files, by Import", files, a.repeat, [&] { described(files.front()); });
    report("text: balls, each with a material", {folder / "balls.pbrt"}, a.repeat,
           [&] { described(folder / "balls.pbrt"); });
    const int triangles = 2 * (a.side - 1) * (a.side - 1);
    report(fmt::format("binary PLY of {:.1f} million triangles", triangles * 1e-6), {folder / "terrain.ply"},
           a.repeat, [&] { read_ply(folder / "terrain.ply"); });
    report("the same until the first ray can be traced", {folder / "terrain.ply"}, a.repeat, [&] {
        Messages messages;
        build_world(described(folder / "terrain.pbrt"), {}, messages);
    });
}

} // namespace
} // namespace alhazen::bench

int main(int argc, char** argv) {
    using namespace alhazen::bench;
    CLI::App app("How fast scenes are read, beside reading nothing but their bytes.", "bench_loading");
    Arguments a;
    app.add_option("--folder", a.folder, "where a folder for the files is made for the time being");
    app.add_option("--megabytes", a.megabytes, "of text")->check(CLI::Range(1, 4000));
    app.add_option("--side", a.side, "vertices along a side of the terrain")->check(CLI::Range(2, 20000));
    app.add_option("--repeat", a.repeat, "times each is timed")->check(CLI::Range(1, 100));
    CLI11_PARSE(app, argc, argv);
    try {
        run(a);
    } catch (const std::exception& e) {
        fmt::print(stderr, "bench_loading: error: {}\n", e.what());
        return 2;
    }
    return 0;
}
