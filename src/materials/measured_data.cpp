#include "materials/measured_data.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "color/spectrum_value.h"

namespace alhazen {

namespace {

[[noreturn]] void fail(std::string_view field, const std::string& text) {
    throw std::runtime_error(fmt::format("field \"{}\" {}", field, text));
}

std::vector<float> increasing(const TensorFile& file, const std::string& name) {
    std::vector<float> values = file.values(name, 1);
    for (std::size_t i = 1; i < values.size(); ++i)
        if (!(values[i] > values[i - 1]))
            fail(name, fmt::format("must increase, but {} is followed by {}", values[i - 1], values[i]));
    return values;
}

/// Tables whose sizes must be the given ones, and at least 2 along the last two dimensions.
struct Tables {
    std::vector<float> values;
    std::size_t nx = 0, ny = 0;
};
Tables tables(const TensorFile& file, const std::string& name, const std::vector<std::size_t>& series) {
    const Tensor& field = file.floats(name, series.size() + 2);
    const std::size_t nx = field.shape.back(), ny = field.shape[series.size()];
    if (!std::equal(series.begin(), series.end(), field.shape.begin()) || nx < 2 || ny < 2) {
        std::string wanted;
        for (std::size_t n : series) wanted += fmt::format("{} x ", n);
        fail(name,
             fmt::format("is {}, but must be {}n x m, with n and m at least 2", field.shape_text(), wanted));
    }
    return {file.values(name, series.size() + 2), nx, ny};
}

BilinearDensities densities(const TensorFile& file, const std::string& name,
                            const std::vector<std::size_t>& series) {
    const Tables read = tables(file, name, series);
    return {read.values, read.nx, read.ny};
}

// The slightly negative values that measuring leaves count as 0.
BilinearTables positive_tables(Tables read) {
    for (float& v : read.values) v = std::max(v, 0.0f);
    return {std::move(read.values), read.nx, read.ny};
}

bool has_facet_factor_in(const TensorFile& file) {
    const Tensor* field = file.find("jacobian");
    if (!field) return true;
    if (field->type != Tensor::Type::uint8 || field->bytes.size() != 1)
        fail("jacobian", "must be a single value of uint8");
    return field->bytes[0] != 0;
}

/// What a unit of each sample adds to the linear sRGB colour that a curve through such samples shows under
/// D65. Colours are clipped at 0 on the way, so the samples are raised by 1 first, of which white is 1.
std::vector<Vec3> color_weights(const std::vector<float>& wavelengths) {
    if (wavelengths.size() == 1) return {Vec3(1)};
    std::vector<Vec3> weights;
    std::vector<float> samples(wavelengths.size(), 1.0f);
    for (float& sample : samples) {
        sample = 2;
        auto curve = std::make_shared<const SpectralCurve>(
            SpectralCurve::from_samples(wavelengths, samples).extended());
        weights.push_back(SpectrumValue::curve(curve, SpectrumRole::albedo).linear_srgb() - Vec3(1));
        sample = 1;
    }
    return weights;
}

Tables colors_of(const Tables& spectra, const std::vector<float>& wavelengths) {
    const std::vector<Vec3> weights = color_weights(wavelengths);
    const std::size_t size = spectra.nx * spectra.ny, count = spectra.values.size() / (size * weights.size());
    Tables colors{std::vector<float>(count * 3 * size), spectra.nx, spectra.ny};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t l = 0; l < weights.size(); ++l) {
            const float* from = spectra.values.data() + (i * weights.size() + l) * size;
            for (std::size_t c = 0; c < 3; ++c) {
                float* to = colors.values.data() + (i * 3 + c) * size;
                const float weight = weights[l][static_cast<int>(c)];
                for (std::size_t k = 0; k < size; ++k) to[k] += weight * from[k];
            }
        }
    return colors;
}

} // namespace

Vec2 MeasuredData::to_square(Vec3 w, float turned) {
    const float theta = std::atan2(std::hypot(w.x, w.y), w.z);
    const float around = (std::atan2(w.y, w.x) - turned + pi) * (inv_pi / 2);
    return {std::sqrt(theta * (2 * inv_pi)), around - std::floor(around)};
}

Vec3 MeasuredData::from_square(Vec2 u, float turned) {
    const float theta = sqr(u.x) * (pi / 2), phi = (2 * u.y - 1) * pi + turned;
    const float sine = std::sin(theta);
    return {sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)};
}

float MeasuredData::solid_angle(Vec2 u) {
    // Never 0, for densities are divided by it.
    return std::max(2 * sqr(pi) * u.x * std::sin(sqr(u.x) * (pi / 2)), 1e-6f);
}

MeasuredData::MeasuredData(const TensorFile& file, ColorMode mode)
    : has_facet_factor(has_facet_factor_in(file)), theta(increasing(file, "theta_i")),
      phi(increasing(file, "phi_i")), wavelengths(increasing(file, "wavelengths")) {
    if (!(wavelengths.front() > 0)) fail("wavelengths", "must be above 0 nm");
    // Two azimuths are the ends of a circle of which nothing depends on the azimuth.
    is_isotropic = phi.size() <= 2;
    if (!is_isotropic && std::lround(2 * pi / (phi.back() - phi.front())) != 1)
        fail("phi_i", fmt::format("goes from {} to {}; only data of the full circle can be read", phi.front(),
                                  phi.back()));
    const std::size_t n_phi = phi.size(), n_theta = theta.size(), n_waves = wavelengths.size();
    ndf = positive_tables(tables(file, "ndf", {}));
    sigma = positive_tables(tables(file, "sigma", {}));
    vndf = densities(file, "vndf", {n_phi, n_theta});
    luminance = densities(file, "luminance", {n_phi, n_theta});
    Tables values = tables(file, "spectra", {n_phi, n_theta, n_waves});
    if (mode == ColorMode::rgb) {
        values = colors_of(values, wavelengths);
        wavelengths.clear();
    }
    spectra = positive_tables(std::move(values));
}

} // namespace alhazen
