#include "cameras/lens_system.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "base/threads.h"
#include "cameras/aperture_mask.h"

namespace alhazen {

namespace {

[[noreturn]] void fail(std::size_t line, const std::string& text) {
    throw std::runtime_error(fmt::format("line {}: {}", line, text));
}

std::vector<double> numbers_of(std::string_view row, std::size_t line) {
    constexpr std::string_view space = " \t\r\v\f";
    std::vector<double> numbers;
    for (;;) {
        row.remove_prefix(std::min(row.find_first_not_of(space), row.size()));
        if (row.empty()) return numbers;
        const std::string_view word = row.substr(0, row.find_first_of(space));
        row.remove_prefix(word.size());
        const std::string_view digits = word.front() == '+' ? word.substr(1) : word;
        double value = 0;
        auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
            fail(line, fmt::format("\"{}\" is not a number", word));
        numbers.push_back(value);
    }
}

LensSurface surface_of(const std::vector<double>& row, std::size_t line) {
    if (row.size() != 4)
        fail(line,
             fmt::format("there are {} numbers; expected 4: radius, thickness, refractive index, diameter",
                         row.size()));
    if (row[1] < 0) fail(line, fmt::format("the thickness is {}; it must not be negative", row[1]));
    if (row[2] != 0 && row[2] < 1)
        fail(line, fmt::format("the refractive index is {}; it must be at least 1, or 0 for air", row[2]));
    if (!(row[3] > 0)) fail(line, fmt::format("the diameter is {}; it must be above 0", row[3]));
    return {row[0] * 1e-3, row[1] * 1e-3, row[2] == 0 ? 1 : row[2], row[3] * 0.5e-3};
}

// The distance to the cap of a sphere around (0, 0, centre) that is nearer to, or farther from, the film.
std::optional<double> meet_cap(Vec3d o, Vec3d d, double centre, double radius, bool is_far) {
    const Vec3d v = o - Vec3d(0, 0, centre);
    const double a = dot(d, d), b = dot(v, d), c = dot(v, v) - radius * radius, discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return std::nullopt;
    const double root = std::sqrt(discriminant);
    return (is_far ? -b + root : -b - root) / a;
}

// Snell's law for a unit direction; eta is the index there over the index here. nullopt: total reflection.
std::optional<Vec3d> refract_unit(Vec3d d, Vec3d n, double eta) {
    double cosine = dot(d, n);
    if (cosine < 0) {
        n = -n;
        cosine = -cosine;
    }
    const double squared = 1 - (1 - cosine * cosine) / (eta * eta);
    if (!(squared >= 0)) return std::nullopt;
    return (d - n * cosine) * (1 / eta) + n * std::sqrt(squared);
}

} // namespace

std::vector<LensSurface> parse_lens(std::string_view text) {
    std::vector<LensSurface> surfaces;
    std::size_t line = 0, last_line = 0;
    bool has_stop = false;
    while (!text.empty()) {
        ++line;
        std::string_view row = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(row.size() + 1, text.size()));
        const std::vector<double> numbers = numbers_of(row.substr(0, row.find('#')), line);
        if (numbers.empty()) continue;
        const LensSurface surface = surface_of(numbers, line);
        if (surface.is_stop()) {
            if (has_stop) fail(line, "a second aperture stop (radius 0); a lens has one");
            if (surface.eta != (surfaces.empty() ? 1 : surfaces.back().eta))
                fail(
                    line,
                    "the aperture stop (radius 0) does not refract; its refractive index must be that of the "
                    "row before it");
            has_stop = true;
        }
        surfaces.push_back(surface);
        last_line = line;
    }
    if (surfaces.empty()) throw std::runtime_error("there is no lens in it; expected rows of 4 numbers");
    if (surfaces.back().eta != 1)
        fail(last_line,
             "the refractive index behind the last surface must be 1, that of air around the film");
    return surfaces;
}

const LensSurface* LensSystem::stop() const {
    auto found = std::find_if(surfaces_.begin(), surfaces_.end(), [](const auto& s) { return s.is_stop(); });
    return found == surfaces_.end() ? nullptr : &*found;
}

void LensSystem::set_stop(double opening) {
    for (LensSurface& s : surfaces_)
        if (s.is_stop()) s.opening = opening;
}

double LensSystem::front_z() const {
    double z = 0;
    for (const LensSurface& s : surfaces_) z += s.thickness;
    return z;
}

// A ray near the axis has a height y and, in each medium, a slope times its index, q; a surface changes q by
// the height times its power, the way between two changes y. One that comes in parallel crosses the axis in
// the focal point on the other side (Born and Wolf 1999, section 4.4).
ThickLens LensSystem::thick_lens() const {
    double y = 1, q = 0, eta = 1;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        const LensSurface& s = surfaces_[i];
        if (!s.is_stop()) q -= y * (s.eta - eta) / s.radius;
        eta = s.eta;
        if (i + 1 < surfaces_.size()) y += s.thickness * q / eta;
    }
    const double focal_length = -1 / q, rear_focus = rear_z() + y / q;
    y = 1;
    q = 0;
    for (std::size_t i = surfaces_.size(); i-- > 0;) {
        const LensSurface& s = surfaces_[i];
        const double ahead = i > 0 ? surfaces_[i - 1].eta : 1;
        if (!s.is_stop()) q -= y * (s.eta - ahead) / s.radius;
        if (i > 0) y += surfaces_[i - 1].thickness * q / ahead;
    }
    const double front_focus = front_z() - y / q;
    return {focal_length, front_focus - focal_length, rear_focus + focal_length};
}

// With s and s' the distances of object and image from the principal planes, 1 / s + 1 / s' = 1 / f, while s
// + s' is what the distance leaves besides the gap between the planes; of the two solutions the one nearer to
// the film.
std::string LensSystem::focus(double distance) {
    const ThickLens lens = thick_lens();
    const double f = lens.focal_length;
    if (!(f > 0) || !std::isfinite(f))
        return "the lens does not bring light together, so that nothing can be in focus";
    const double gap = lens.front_principal - lens.rear_principal, sum = distance - gap;
    if (!(sum >= 4 * f))
        return fmt::format(
            "the lens cannot be focused at {} m; the nearest that it can is {:.4g} m from the film", distance,
            4 * f + gap);
    // (sum - sqrt(sum^2 - 4 f sum)) / 2 without cancellation.
    const double image = 2 * f * sum / (sum + std::sqrt(sum * (sum - 4 * f)));
    const double thickness = rear_z() + (image - lens.rear_principal);
    if (!(thickness > 0)) return fmt::format("focused at {} m, the lens would stand in the film", distance);
    surfaces_.back().thickness = thickness;
    return "";
}

std::optional<LensRay> LensSystem::trace(Vec3d o, Vec3d d, const ApertureMask* mask, double opened) const {
    LensRay ray{o, normalize(d)};
    double z = 0;
    for (std::size_t i = surfaces_.size(); i-- > 0;) {
        const LensSurface& s = surfaces_[i];
        z += s.thickness;
        const double centre = z - s.radius;
        const std::optional<double> t = s.is_stop() ? std::optional((z - ray.o.z) / ray.d.z)
                                                    : meet_cap(ray.o, ray.d, centre, s.radius, s.radius > 0);
        if (!t || !(*t >= 0)) return std::nullopt;
        ray.o += ray.d * *t;
        if (s.is_stop() && mask) {
            ray.weight = mask->at({ray.o.x / s.opening, ray.o.y / s.opening});
            if (!(ray.weight > 0)) return std::nullopt;
        } else {
            const double opening = s.is_stop() ? s.opening * opened : s.opening;
            if (!(ray.o.x * ray.o.x + ray.o.y * ray.o.y <= opening * opening)) return std::nullopt;
        }
        if (s.is_stop()) continue;
        const double ahead = i > 0 ? surfaces_[i - 1].eta : 1;
        const Vec3d normal = (ray.o - Vec3d(0, 0, centre)) * (1 / s.radius);
        const std::optional<Vec3d> bent = refract_unit(ray.d, normal, ahead / s.eta);
        if (!bent || !(bent->z > 0)) return std::nullopt;
        ray.d = *bent;
    }
    return ray;
}

ExitPupil::ExitPupil(const LensSystem& lens, double film_radius)
    : rectangles_(rings), film_radius_(film_radius), z_(lens.rear_z()) {
    parallel_for(rings, 1, [&](std::size_t i) {
        const double width = film_radius / rings;
        rectangles_[i] = bound(lens, static_cast<double>(i) * width, static_cast<double>(i + 1) * width);
    });
}

// A small stop would fall between the places that are tried: it is looked for with the stop wider open at
// first, and then less and less, within where the wider one was found.
ExitPupil::Rectangle ExitPupil::bound(const LensSystem& lens, double film_lo, double film_hi) {
    const double reach = 1.5 * lens.rear_opening();
    Rectangle found{-reach, reach, reach};
    const LensSurface* stop = lens.stop();
    for (double opened = stop ? std::max(1.0, lens.rear_opening() / (4 * stop->opening)) : 1;;
         opened = std::max(1.0, opened / 4)) {
        found = bound(lens, film_lo, film_hi, found, opened);
        if (opened == 1 || !(found.hi > found.lo)) return found;
    }
}

// Rays from the ring, on the x axis, to a grid over the half y >= 0 of the last surface and its surroundings
// (what bulges towards the film is seen larger, in its vertex's plane); the margin is that of two cells of
// the grid.
ExitPupil::Rectangle ExitPupil::bound(const LensSystem& lens, double film_lo, double film_hi,
                                      const Rectangle& within, double opened) {
    constexpr int columns = 256, rows = 128;
    const double width = (within.hi - within.lo) / columns, height = within.half / rows;
    constexpr double inf = std::numeric_limits<double>::infinity();
    Rectangle r{inf, -inf, -inf};
    for (int row = rows; row-- > 0;)
        for (int column = 0; column < columns; ++column) {
            const Vec3d p{within.lo + (column + 0.5) * width, (row + 0.5) * height, lens.rear_z()};
            if (p.x >= r.lo && p.x <= r.hi && p.y <= r.half) continue;
            // Places in the ring by the golden ratio, so that all come up around each point of the grid.
            const double part = std::fmod((row * columns + column) * std::numbers::phi, 1.0);
            const Vec3d film{film_lo + (film_hi - film_lo) * part, 0, 0};
            if (!lens.trace(film, p - film, nullptr, opened)) continue;
            r = {std::min(r.lo, p.x), std::max(r.hi, p.x), std::max(r.half, p.y)};
        }
    if (r.lo > r.hi) return {};
    return {r.lo - 2 * width, r.hi + 2 * width, r.half + 2 * height};
}

std::optional<ExitPupil::Sample> ExitPupil::sample(Vec2d film, Vec2 u) const {
    const double distance = length(film);
    const auto ring = static_cast<std::size_t>(distance / film_radius_ * rings);
    const Rectangle& r = rectangles_[std::min(ring, rings - 1)];
    if (!(r.hi > r.lo)) return std::nullopt;
    const double x = r.lo + (r.hi - r.lo) * static_cast<double>(u.x),
                 y = r.half * (2 * static_cast<double>(u.y) - 1);
    // The rectangle turns with the place on the film.
    const double c = distance > 0 ? film.x / distance : 1, s = distance > 0 ? film.y / distance : 0;
    return Sample{{c * x - s * y, s * x + c * y, z_}, (r.hi - r.lo) * 2 * r.half};
}

} // namespace alhazen
