#include "cli/options.h"

#include <cctype>
#include <charconv>
#include <limits>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "image/image.h"

namespace alhazen {

namespace {

// Whole numbers with separators between them: "800x600", "0,0,10,20". Empty when the text is anything else.
std::vector<int> split_integers(const std::string& text, char separator) {
    std::vector<int> numbers;
    const char* at = text.data();
    const char* end = at + text.size();
    for (;;) {
        int value = 0;
        auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc{}) return {};
        numbers.push_back(value);
        if (next == end) return numbers;
        if (*next != separator) return {};
        at = next + 1;
    }
}

void read_size(const std::string& text, RenderSettings& settings) {
    auto n = split_integers(text, 'x');
    if (n.size() != 2 || n[0] < 1 || n[1] < 1 || n[0] > Image::max_side || n[1] > Image::max_side)
        throw CLI::ValidationError(
            "--size", fmt::format("\"{}\" is not a size; write it as 800x600 (1 to 65536)", text));
    constexpr std::size_t most_pixels = Image::max_values / 3;
    if (static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) > most_pixels)
        throw CLI::ValidationError(
            "--size",
            fmt::format("{} x {} is too large; at most {} pixels are possible", n[0], n[1], most_pixels));
    settings.size = Vec2i{n[0], n[1]};
}

void read_crop(const std::string& text, RenderSettings& settings) {
    auto n = split_integers(text, ',');
    if (n.size() != 4)
        throw CLI::ValidationError(
            "--crop", fmt::format("\"{}\" is not a crop; write it as X0,Y0,X1,Y1 in pixels", text));
    settings.crop = Rect2i{{n[0], n[1]}, {n[2], n[3]}};
}

void read_accel(const std::string& text, RenderSettings& settings) {
    std::string error;
    settings.accel = parse_accel(text, error);
    if (!settings.accel) throw CLI::ValidationError("--accel", error);
}

// "512M": bytes, in powers of 1024.
void read_texture_memory(const std::string& text, RenderSettings& settings) {
    constexpr std::string_view units = "KMGT";
    std::size_t count = 0;
    const char* end = text.data() + text.size();
    auto [unit, error] = std::from_chars(text.data(), end, count);
    int shift = 0;
    if (error == std::errc{} && unit + 1 == end) {
        const auto which = units.find(static_cast<char>(std::toupper(static_cast<unsigned char>(*unit))));
        if (which != std::string_view::npos) {
            shift = 10 * (static_cast<int>(which) + 1);
            ++unit;
        }
    }
    constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
    if (error != std::errc{} || unit != end || count == 0 || count > most >> shift)
        throw CLI::ValidationError(
            "--texture-memory",
            fmt::format("\"{}\" is not an amount of memory; write it as 512M or 2G (K, M, G, T)", text));
    settings.texture_memory = count << shift;
}

void read_seed(const std::string& text, RenderSettings& settings) {
    std::uint64_t seed = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, seed);
    if (error != std::errc{} || rest != end)
        throw CLI::ValidationError(
            "--seed", fmt::format("\"{}\" is not a whole number from 0 to 18446744073709551615", text));
    settings.seed = seed;
}

} // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
    RenderSettings& s = options.settings;
    command.add_option("--spp", s.spp, "samples per pixel")->check(CLI::Range(1, 1 << 24))->type_name("N");
    command
        .add_option_function<std::string>(
            "--size", [&s](const std::string& text) { read_size(text, s); }, "film resolution in pixels")
        ->type_name("WxH");
    command
        .add_option_function<std::string>(
            "--crop", [&s](const std::string& text) { read_crop(text, s); },
            "render these pixels only (X1, Y1 excluded)")
        ->type_name("X0,Y0,X1,Y1");
    command.add_option("--integrator", s.integrator, "use this integrator (alhazen help integrator)")
        ->type_name("NAME");
    command.add_option("--camera", s.camera, "use the camera of this name")->type_name("NAME");
    command
        .add_option_function<std::string>(
            "--seed", [&s](const std::string& text) { read_seed(text, s); }, "seed of the random numbers")
        ->type_name("N");
    command
        .add_option_function<std::string>(
            "--accel", [&s](const std::string& text) { read_accel(text, s); },
            "acceleration structure, e.g. lbvh/stackless; sdf is approximate (alhazen help accelerator)")
        ->type_name("BUILDER/WALK");
    command.add_option("--stack-entries", s.stack_entries, "of the walk with a short stack")
        ->check(CLI::Range(1, 64))
        ->type_name("N");
    command.add_option("--threads", s.threads, "how many threads (default: all)")
        ->check(CLI::Range(0, 4096))
        ->type_name("N");
    command
        .add_option_function<std::string>(
            "--texture-memory", [&s](const std::string& text) { read_texture_memory(text, s); },
            "texels of images in memory at most, the others in a temporary file (default: all in memory)")
        ->type_name("SIZE");
    command.add_option("--tile-size", s.tile_size, "pixels a thread takes at a time")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
    command
        .add_option("--in-flight", s.paths_in_flight,
                    "paths a thread follows at a time (1: each ray alone; default: by the scene's size and "
                    "accelerator)")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
    command
        .add_option_function<std::string>(
            "--color", [&s](const std::string& mode) { s.color = find_color_mode(mode); },
            "compute in sampled wavelengths or in RGB")
        ->check(CLI::IsMember({"spectral", "rgb"}))
        ->type_name("spectral|rgb");
    command.add_flag("--lenient", options.lenient, "replace what is unknown and say so, instead of stopping");
    command
        .add_option("--set", s.overrides,
                    "set a parameter, e.g. integrator.maxdepth=3 or material.Floor.roughness=.1")
        ->type_name("PATH=VALUE")
        ->expected(1)
        ->take_all();
}

} // namespace alhazen
