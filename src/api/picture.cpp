#include "api/picture.h"

#include "api/convert.h"

namespace alhazen {

Picture::Picture(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

int Picture::width() const {
    return content_->image.width();
}
int Picture::height() const {
    return content_->image.height();
}
std::span<const float> Picture::pixels() const {
    return content_->image.values();
}
int Picture::samples() const {
    return content_->samples;
}
double Picture::seconds() const {
    return content_->seconds;
}
std::uint64_t Picture::rays() const {
    return content_->rays;
}
bool Picture::was_stopped() const {
    return content_->was_stopped;
}
const std::vector<Notice>& Picture::warnings() const {
    return content_->warnings;
}

void Picture::write(const std::filesystem::path& file) const {
    try {
        write_image(file, content_->image, content_->write_options);
    } catch (const std::runtime_error& error) {
        throw make_input_error(file.string(), error.what());
    }
}

} // namespace alhazen
