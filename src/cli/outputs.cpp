#include "cli/outputs.h"

#include <filesystem>
#include <stdexcept>

#include <unistd.h>

#include <fmt/format.h>

#include "image/codec.h"

namespace alhazen {

void check_output_folder(const std::string& file) {
    std::filesystem::path path(file);
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
