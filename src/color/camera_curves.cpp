#include "color/camera_curves.h"

#include <algorithm>

namespace alhazen {

namespace {

constexpr CameraCurves cameras[] = {
#include "color/data/cameras.inl"
};

constexpr std::size_t swatch_samples = 36;
constexpr float swatches[24 * swatch_samples] = {
#include "color/data/color_checker.inl"
};

using ThreeCurves = std::array<SpectralCurve, 3>;

// Sums over each whole nm of the light, as the swatch reflects it, times each curve.
Vec3d answers(const ThreeCurves& curves, const SpectralCurve& light, const SpectralCurve& swatch) {
    Vec3d sum;
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda) {
        const double radiance = static_cast<double>(light.eval(lambda)) * swatch.eval(lambda);
        sum += Vec3d(curves[0].eval(lambda), curves[1].eval(lambda), curves[2].eval(lambda)) * radiance;
    }
    return sum;
}

// The sum of matrices a b^T.
class OuterProducts {
  public:
    void add(Vec3d a, Vec3d b) {
        columns_[0] += a * b.x;
        columns_[1] += a * b.y;
        columns_[2] += a * b.z;
    }
    Matrix3 sum() const { return Matrix3::from_columns(columns_[0], columns_[1], columns_[2]); }
    // Of the sum: its determinant against that of a multiple of the identity with the same trace, 0 to 1.
    double roundness() const {
        const double mean = (columns_[0].x + columns_[1].y + columns_[2].z) / 3;
        return dot(columns_[0], cross(columns_[1], columns_[2])) / (mean * mean * mean);
    }

  private:
    std::array<Vec3d, 3> columns_;
};

} // namespace

ObserverSample CameraCurves::sample(Spectrum lambda) const {
    ObserverSample sample;
    for (int lane = 0; lane < 4; ++lane) {
        const float x = (lambda[lane] - lambda_first) / lambda_step;
        if (!(x >= 0 && x <= static_cast<float>(count - 1))) continue;
        const std::size_t i = std::min(static_cast<std::size_t>(x), count - 2);
        const float t = x - static_cast<float>(i);
        const float* row = rgb.data() + 3 * i;
        sample.x.set(lane, lerp(t, row[0], row[3]));
        sample.y.set(lane, lerp(t, row[1], row[4]));
        sample.z.set(lane, lerp(t, row[2], row[5]));
    }
    return sample;
}

SpectralCurve CameraCurves::curve(std::size_t channel) const {
    std::vector<float> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(rgb[3 * i + channel]);
    return SpectralCurve::uniform(lambda_first, lambda_step, std::move(values));
}

std::span<const CameraCurves> all_camera_curves() {
    return cameras;
}

const CameraCurves* find_camera_curves(std::string_view name) {
    const auto* found = std::ranges::find(cameras, name, &CameraCurves::name);
    return found == std::end(cameras) ? nullptr : found;
}

const std::vector<SpectralCurve>& color_checker() {
    static const std::vector<SpectralCurve> list = [] {
        std::vector<SpectralCurve> curves;
        for (const float* first = swatches; first != std::end(swatches); first += swatch_samples)
            curves.push_back(SpectralCurve::uniform(380, 10, {first, first + swatch_samples}));
        return curves;
    }();
    return list;
}

std::optional<Matrix3> xyz_from_camera(const CameraCurves& camera, const SpectralCurve& scene_light,
                                       const SpectralCurve& output_light) {
    const ThreeCurves rgb{camera.curve(0), camera.curve(1), camera.curve(2)};
    const ThreeCurves xyz{cie_x(), cie_y(), cie_z()};
    // White answers g = 1 in the camera's unit and Y = 1 in the picture's.
    const double camera_unit = answers(rgb, scene_light, SpectralCurve::constant(1)).y;
    const double picture_unit = y_integral(output_light);
    const double luminance = y_integral(scene_light) / camera_unit;

    // The normal equations of M a = b over all swatches: M = (sum b a^T) (sum a a^T)^-1.
    OuterProducts mixed, square;
    for (const SpectralCurve& swatch : color_checker()) {
        const Vec3d a = answers(rgb, scene_light, swatch) / camera_unit;
        const Vec3d b = answers(xyz, output_light, swatch) * (luminance / picture_unit);
        mixed.add(b, a);
        square.add(a, a);
    }
    // Measured: 3e-3 to 1e-2 for daylight, 1e-6 for a black body of 1000 K. False for NaN, too.
    if (!(square.roundness() > 1e-9)) return std::nullopt;
    return mixed.sum() * square.sum().inverse();
}

} // namespace alhazen
