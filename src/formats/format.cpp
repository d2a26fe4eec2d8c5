#include "formats/format.h"

#include <fmt/format.h>

#include "base/file.h"
#include "formats/list.h"
#include "formats/pbrt/parser.h"

namespace alhazen {

namespace {

std::string suffix_of(std::filesystem::path file) {
    if (file.extension() == ".gz") file = file.stem();
    std::string suffix = file.extension().string();
    for (char& c : suffix) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    return suffix;
}

[[noreturn]] void throw_unknown_format(const std::filesystem::path& file, const std::string& suffix) {
    std::string known;
    for (const SceneFormat& format : scene_formats)
        known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", format.suffix, format.name);
    throw SceneError(Place::of_file(file.string()),
                     fmt::format("{}; expected a scene in one of: {}",
                                 suffix.empty()
                                     ? "a file name without a suffix"
                                     : fmt::format("unknown scene format \"{}\"", printable(suffix)),
                                 known));
}

} // namespace

SceneDescription read_pbrt(std::string_view text, const std::filesystem::path& file,
                           const std::filesystem::path& base_folder, Messages& messages) {
    auto name = std::make_shared<const std::string>(file.empty() ? "<string>" : file.string());
    std::filesystem::path real = file.empty() ? file : real_path(file);
    PbrtBuilder builder(file, base_folder, messages);
    Place end = PbrtParser(builder, base_folder).parse(text, std::move(name), real);
    return builder.finish(std::move(end));
}

SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& base_folder,
                                  Messages& messages) {
    return read_pbrt(text, "", base_folder, messages);
}

SceneDescription read_scene(const std::filesystem::path& file, Messages& messages) {
    std::string suffix = suffix_of(file);
    for (const SceneFormat& format : scene_formats) {
        if (format.suffix != suffix) continue;
        std::string text;
        try {
            text = read_file(file);
        } catch (const std::runtime_error& error) {
            throw SceneError(Place::of_file(file.string()),
                             fmt::format("cannot read the scene: {}", error.what()));
        }
        return format.read(text, file, file.parent_path(), messages);
    }
    throw_unknown_format(file, suffix);
}

} // namespace alhazen
