/// The cube of colours is divided into cells, finer where it
/// is dark; in the middle of a cell the fit and its first two derivatives after the colour (by the theorem of
/// the implicit function) are computed when the first colour falls there, and give the others. Where the
/// corners of the cell do not come back well enough (next to black and white, mostly), each colour is fitted.
#include "color/upsample_many.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "base/hash.h"
#include "base/threads.h"
#include "color/sigmoid_quadrature.h"

namespace alhazen {

namespace {

/// Cells along each axis, evenly spaced in the square root of linear RGB.
constexpr int resolution = 64;
/// At the corners, where the error is largest; between there may be a little more.
constexpr double largest_corner_error = 0.8 * upsample_error;

Spectrum to_lanes(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0};
}

/// Which cell: x + resolution (y + resolution z).
using CellNumber = std::uint32_t;

CellNumber cell_of(Vec3 rgb) {
    const Spectrum at = sqrt(Spectrum(rgb.x, rgb.y, rgb.z, 0)) * static_cast<float>(resolution);
    auto axis = [&](int i) { return static_cast<CellNumber>(std::min(at[i], resolution - 0.5f)); };
    return axis(0) + resolution * (axis(1) + resolution * axis(2));
}

struct Cell {
    bool is_fitted = false; ///< false: its colours must be fitted one by one
    Vec3 middle;
    Spectrum coefficients; ///< there
    std::array<Spectrum, 3> first;
    std::array<Spectrum, 5> second;

    Cell(const RgbColorSpace& space, const SigmoidQuadrature& quadrature, CellNumber number);

    SigmoidCoefficients at(Vec3 rgb) const {
        const Vec3 d = rgb - middle;
        const Spectrum step = first[0] * d.x + first[1] * d.y + first[2] * d.z;
        // Products of the step's coefficients, by the power of t that they stand at.
        const float s0 = step[0], s1 = step[1], s2 = step[2];
        const Spectrum c = coefficients + step + second[0] * (s2 * s2) + second[1] * (2 * s1 * s2) +
                           second[2] * (s1 * s1 + 2 * s0 * s2) + second[3] * (2 * s0 * s1) +
                           second[4] * (s0 * s0);
        return {c[0], c[1], c[2]};
    }
};

Cell::Cell(const RgbColorSpace& space, const SigmoidQuadrature& quadrature, CellNumber number) {
    const Vec3i at{static_cast<int>(number % resolution), static_cast<int>(number / resolution % resolution),
                   static_cast<int>(number / resolution / resolution)};
    std::array<Vec3, 2> ends;
    for (int axis = 0; axis < 3; ++axis)
        for (int end = 0; end < 2; ++end)
            ends[static_cast<std::size_t>(end)][axis] =
                sqr(static_cast<float>(at[axis] + end) / static_cast<float>(resolution));
    middle = (ends[0] + ends[1]) * 0.5f;

    const SigmoidCoefficients fit = upsample(space, middle);
    const SigmoidColor color = quadrature.color(fit);
    const Matrix3 inverse = color.by_coefficient.inverse();
    coefficients = to_lanes({fit.c0, fit.c1, fit.c2});
    first = {to_lanes(inverse * Vec3d(1, 0, 0)), to_lanes(inverse * Vec3d(0, 1, 0)),
             to_lanes(inverse * Vec3d(0, 0, 1))};
    const SigmoidCurvature curvature = quadrature.curvature(fit);
    for (std::size_t i = 0; i < second.size(); ++i) second[i] = to_lanes(inverse * curvature[i] * -0.5);

    is_fitted = true;
    for (std::size_t corner = 0; corner < 8 && is_fitted; ++corner) {
        const Vec3 rgb{ends[corner & 1].x, ends[corner >> 1 & 1].y, ends[corner >> 2].z};
        is_fitted = max_component(abs(quadrature.rgb(this->at(rgb)) - Vec3d(rgb))) <= largest_corner_error;
    }
}

} // namespace

/// The cells that colours have fallen into so far. What is in a cell depends on its number alone.
class PictureUpsampler::Cells {
  public:
    explicit Cells(const RgbColorSpace& space) : space_(space), quadrature_(space) {}

    void upsample_run(std::span<const Vec3> rgb, std::span<SigmoidCoefficients> out);

    const Cell& get(CellNumber number) {
        {
            std::lock_guard lock(mutex_);
            if (auto it = cells_.find(number); it != cells_.end()) return it->second;
        }
        // Another thread may be making the same one.
        Cell cell(space_, quadrature_, number);
        std::lock_guard lock(mutex_);
        return cells_.try_emplace(number, cell).first->second;
    }

  private:
    class Lookup;

    const RgbColorSpace& space_;
    SigmoidQuadrature quadrature_;
    std::mutex mutex_;
    std::unordered_map<CellNumber, Cell> cells_;
};

/// What a thread has seen lately: pictures show the same cells, and the same colours, again and again.
class PictureUpsampler::Cells::Lookup {
  public:
    explicit Lookup(Cells& cells) : cells_(cells), recent_(1024), known_(1024) {}

    SigmoidCoefficients find(Vec3 rgb) {
        if (rgb.x == rgb.y && rgb.y == rgb.z) return SigmoidCoefficients::grey(rgb.x);
        const CellNumber number = cell_of(rgb);
        Recent& recent = recent_[(number ^ number >> 10) % recent_.size()];
        if (!recent.cell || recent.number != number) recent = {number, &cells_.get(number)};
        return recent.cell->is_fitted ? recent.cell->at(rgb) : fit(rgb);
    }

  private:
    struct Recent {
        CellNumber number = 0;
        const Cell* cell = nullptr;
    };
    struct Known {
        Vec3 rgb{-1, -1, -1};
        SigmoidCoefficients coefficients;
    };

    SigmoidCoefficients fit(Vec3 rgb) {
        auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
        Known& k = known_[hash_of(bits(rgb.x), bits(rgb.y), bits(rgb.z)) % known_.size()];
        if (!(k.rgb == rgb)) k = {rgb, upsample(cells_.space_, rgb)};
        return k.coefficients;
    }

    Cells& cells_;
    std::vector<Recent> recent_;
    std::vector<Known> known_;
};

void PictureUpsampler::Cells::upsample_run(std::span<const Vec3> rgb, std::span<SigmoidCoefficients> out) {
    Lookup lookup(*this);
    // Written so that NaN becomes 0.
    auto in_range = [](float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; };
    for (std::size_t i = 0; i < rgb.size(); ++i)
        out[i] = lookup.find({in_range(rgb[i].x), in_range(rgb[i].y), in_range(rgb[i].z)});
}

PictureUpsampler::PictureUpsampler(const RgbColorSpace& space) : cells_(std::make_unique<Cells>(space)) {}
PictureUpsampler::~PictureUpsampler() = default;
PictureUpsampler::PictureUpsampler(PictureUpsampler&&) noexcept = default;
PictureUpsampler& PictureUpsampler::operator=(PictureUpsampler&&) noexcept = default;

void PictureUpsampler::operator()(std::span<const Vec3> rgb, std::span<SigmoidCoefficients> out) const {
    parallel_ranges(rgb.size(), 16384, [&](std::size_t begin, std::size_t end) {
        cells_->upsample_run(rgb.subspan(begin, end - begin), out.subspan(begin, end - begin));
    });
}

void upsample(const RgbColorSpace& space, std::span<const Vec3> rgb, std::span<SigmoidCoefficients> out) {
    PictureUpsampler{space}(rgb, out);
}

} // namespace alhazen
