#include "cameras/aperture_mask.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace alhazen {

namespace {

constexpr int side = 256; // pixels of the shapes

// f takes places from -1 to 1, y up.
template <class F>
Image drawn(F f) {
    Image image = Image::grey_image(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            image.at(x, y) = static_cast<float>(f(Vec2d{2 * (x + 0.5) / side - 1, 1 - 2 * (y + 0.5) / side}));
    return image;
}

// By how often a line to the right crosses the sides.
bool is_inside(const std::vector<Vec2d>& corners, Vec2d p) {
    bool inside = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2d a = corners[i], b = corners[(i + 1) % corners.size()];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y))
            inside = !inside;
    }
    return inside;
}

Vec2d on_circle(double radius, double angle) {
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

// A corner down, within a circle of 0.8 radii.
std::vector<Vec2d> pentagon() {
    std::vector<Vec2d> corners;
    for (int i = 0; i < 5; ++i) corners.push_back(on_circle(0.8, std::numbers::pi * (1.5 + 0.4 * i)));
    return corners;
}

// A pentagram's outline, a point to the left.
std::vector<Vec2d> star() {
    using std::numbers::pi;
    const double inner = std::cos(0.4 * pi) / std::cos(0.2 * pi);
    std::vector<Vec2d> corners;
    for (int i = 0; i < 10; ++i) corners.push_back(on_circle(i % 2 == 0 ? inner : 1, 0.2 * pi * i));
    return corners;
}

} // namespace

std::optional<ApertureMask> ApertureMask::named(std::string_view name) {
    if (name == "gaussian")
        return ApertureMask(
            drawn([](Vec2d p) { return std::max(0.0, std::exp(-dot(p, p)) - std::exp(-1.0)); }));
    if (name == "square")
        return ApertureMask(
            drawn([](Vec2d p) { return std::abs(p.x) < 0.5 && std::abs(p.y) < 0.5 ? 1 : 0; }));
    if (name == "pentagon")
        return ApertureMask(drawn([c = pentagon()](Vec2d p) { return is_inside(c, p) ? 1 : 0; }));
    if (name == "star") return ApertureMask(drawn([c = star()](Vec2d p) { return is_inside(c, p) ? 1 : 0; }));
    return std::nullopt;
}

ApertureMask::ApertureMask(const Image& image) : width_(image.width()), height_(image.height()) {
    double sum = 0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const Vec3 color = image.rgb(x, y);
            const float value = (color.x + color.y + color.z) / 3;
            if (!(value >= 0) || !std::isfinite(value))
                throw std::runtime_error(
                    "a pixel is negative or not finite; it must say how much light passes");
            values_.push_back(value);
            sum += static_cast<double>(value);
            if (value == 0) continue;
            // The farthest corner of what interpolation spreads the pixel over.
            const double px = std::abs(2 * (x + 0.5) / width_ - 1) + 2.0 / width_;
            const double py = std::abs(2 * (y + 0.5) / height_ - 1) + 2.0 / height_;
            reach_ = std::max(reach_, std::hypot(std::min(px, 1.0), std::min(py, 1.0)));
        }
    if (!(sum > 0)) throw std::runtime_error("it lets no light through");
    const double scale = std::numbers::pi / 4 * static_cast<double>(values_.size()) / sum;
    for (float& value : values_) value = static_cast<float>(static_cast<double>(value) * scale);
}

double ApertureMask::pixel(int x, int y) const {
    x = std::clamp(x, 0, width_ - 1);
    y = std::clamp(y, 0, height_ - 1);
    return static_cast<double>(values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                       static_cast<std::size_t>(x)]);
}

double ApertureMask::at(Vec2d place) const {
    if (!(std::abs(place.x) <= 1 && std::abs(place.y) <= 1)) return 0;
    const double x = (place.x + 1) / 2 * width_ - 0.5, y = (1 - place.y) / 2 * height_ - 0.5;
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const double upper = pixel(x0, y0) * (1 - fx) + pixel(x0 + 1, y0) * fx;
    const double lower = pixel(x0, y0 + 1) * (1 - fx) + pixel(x0 + 1, y0 + 1) * fx;
    return upper * (1 - fy) + lower * fy;
}

} // namespace alhazen
