#include "cli/outputs.h"

#include <filesystem>
#include <map>
#include <stdexcept>

#include <unistd.h>

#include <fmt/format.h>

#include "base/file.h"
#include "image/codec.h"

namespace alhazen {

void check_outputs(const std::string& input, const std::vector<std::string>& files) {
    std::map<std::filesystem::path, std::string> taken;
    const std::filesystem::path read_from = real_path(input);
    for (const std::string& file : files) {
        if (file.empty()) continue;
        check_output_folder(file);
        const auto place = real_path(file);
        if (place == read_from)
            throw std::runtime_error(
                fmt::format("cannot write \"{}\": it is what is read; give another name", file));
        if (!taken.emplace(place, file).second)
            throw std::runtime_error(
                fmt::format("cannot write \"{}\" twice; give each output a name of its own", file));
    }
}

void check_output_folder(const std::string& file) {
    std::filesystem::path path(file);
    if (is_stream(path)) return;
    if (std::filesystem::is_directory(path))
        throw std::runtime_error(fmt::format("cannot write \"{}\": it is a folder", file));
    std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (!std::filesystem::is_directory(folder))
        throw std::runtime_error(
            fmt::format("cannot write \"{}\": there is no folder \"{}\"", file, folder.string()));
    if (access(folder.c_str(), W_OK) != 0)
        throw std::runtime_error(
            fmt::format("cannot write \"{}\": no permission in folder \"{}\"", file, folder.string()));
}

void check_picture_output(const std::string& file) {
    std::filesystem::path path(file);
    if (!has_image_suffix(path)) {
        std::string known;
        for (const std::string& suffix : image_suffixes()) known += (known.empty() ? "" : ", ") + suffix;
        throw std::runtime_error(
            fmt::format("cannot write \"{}\": the suffix must be one of {}", file, known));
    }
    check_output_folder(file);
}

} // namespace alhazen
