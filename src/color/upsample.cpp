/// Fitting sigmoid spectra to colours (Jakob and Hanika 2019, section 3). The error is the difference in CIE
/// Lab, so that colours which no such spectrum has come out as near as the eye can tell; it is reduced by
/// Gauss-Newton steps, damped where they overshoot (Levenberg and Marquardt). A coarse table of solutions
/// gives each lookup its start.
#include "color/upsample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "color/sigmoid_quadrature.h"

namespace alhazen {

namespace {

/// Steeper spectra than this are steps within a few nm, which the nodes below cannot resolve.
constexpr double coefficient_limit = 200;

SigmoidCoefficients to_float(Vec3d c) {
    return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}
Vec3d to_double(SigmoidCoefficients c) {
    return {c.c0, c.c1, c.c2};
}

/// CIE 1976 L*a*b* relative to the space's white, over 100, and its derivatives after XYZ / white.
struct Lab {
    Vec3d value;
    Matrix3 by_xyz;
};

Lab lab_of(Vec3d xyz) {
    constexpr double knee = 6.0 / 29;
    Vec3d f, slope;
    for (int i = 0; i < 3; ++i) {
        bool linear = xyz[i] < knee * knee * knee;
        f[i] = linear ? xyz[i] / (3 * knee * knee) + 4.0 / 29 : std::cbrt(xyz[i]);
        slope[i] = linear ? 1 / (3 * knee * knee) : 1 / (3 * f[i] * f[i]);
    }
    return {{1.16 * f.y - 0.16, 5 * (f.x - f.y), 2 * (f.y - f.z)},
            {{{{0, 1.16 * slope.y, 0}, {5 * slope.x, -5 * slope.y, 0}, {0, 2 * slope.y, -2 * slope.z}}}}};
}

Matrix3 transposed(const Matrix3& a) {
    return {{{{a.m[0][0], a.m[1][0], a.m[2][0]},
              {a.m[0][1], a.m[1][1], a.m[2][1]},
              {a.m[0][2], a.m[1][2], a.m[2][2]}}}};
}

double largest(Vec3d v) {
    return max_component(abs(v));
}

/// A point on the way to the solution.
struct Guess {
    Vec3d coefficients, rgb, residual;
    Matrix3 jacobian; ///< of the residual
    double error = 0;
};

class Upsampler {
  public:
    explicit Upsampler(const RgbColorSpace& space) : quadrature_(space) {
        // XYZ over the white's, by rows, so that white has f = 1 in all three.
        Vec3d white = space.xyz_from_rgb * Vec3d(1, 1, 1);
        xyz_from_rgb_ = Matrix3::diagonal({1 / white.x, 1 / white.y, 1 / white.z}) * space.xyz_from_rgb;
        for (int k = 0; k < resolution; ++k) {
            float s = smoothstep(smoothstep(static_cast<float>(k) / (resolution - 1)));
            scales_[static_cast<std::size_t>(k)] = s;
        }
        table_.resize(std::size_t{3} * resolution * resolution * resolution);
        for (int i = 0; i < 3; ++i) {
            for (int y = 0; y < resolution; ++y) {
                for (int x = 0; x < resolution; ++x) fill_column(i, y, x);
            }
        }
    }

    /// rgb in [0, 1], not grey. Most colours are reached from the table in a Newton step or two; the careful
    /// way is for those that are not.
    SigmoidCoefficients find(Vec3 rgb) const {
        const Vec3d start = interpolate(rgb);
        Vec3d c = start;
        for (int i = 0; i < newton_steps; ++i) {
            const SigmoidColor color = quadrature_.color(to_float(c));
            const Vec3d residual = color.rgb - Vec3d(rgb);
            if (largest(residual) <= good_enough) return to_float(c);
            c -= color.by_coefficient.inverse() * residual;
            if (!(largest(c) < coefficient_limit)) break;
        }
        return to_float(best_of(Vec3d(rgb), start, polish_steps));
    }

  private:
    static constexpr int resolution = 20;
    static constexpr int newton_steps = 4, fit_steps = 25, polish_steps = 6;
    static constexpr double good_enough = 1e-5; ///< largest difference in linear RGB

    static float smoothstep(float x) { return x * x * (3 - 2 * x); }
    static std::size_t index(int i, int z, int y, int x) {
        return static_cast<std::size_t>(((i * resolution + z) * resolution + y) * resolution + x);
    }

    /// Colours of one hue and saturation, from dark to light: each starts from its neighbour's solution.
    void fill_column(int i, int y, int x) {
        constexpr int start = resolution / 4;
        for (int direction : {1, -1}) {
            Vec3d c = direction > 0 ? Vec3d() : to_double(table_[index(i, start, y, x)]);
            for (int z = direction > 0 ? start : start - 1; z >= 0 && z < resolution; z += direction) {
                // Black has no finite coefficients; a colour below the second row stands for it.
                double s = z > 0 ? std::min(scales_[static_cast<std::size_t>(z)], 0.99f) : scales_[1] * 0.1f;
                Vec3d rgb;
                rgb[i] = s;
                rgb[(i + 1) % 3] = s * x / (resolution - 1);
                rgb[(i + 2) % 3] = s * y / (resolution - 1);
                c = best_of(rgb, c, fit_steps);
                table_[index(i, z, y, x)] = to_float(c);
            }
        }
    }

    Vec3d interpolate(Vec3 rgb) const {
        int i = max_dimension(rgb);
        float z = rgb[i];
        float x = rgb[(i + 1) % 3] / z * (resolution - 1), y = rgb[(i + 2) % 3] / z * (resolution - 1);
        auto above = std::upper_bound(scales_.begin() + 1, scales_.end() - 1, z);
        int zi = static_cast<int>(above - scales_.begin()) - 1;
        auto at = static_cast<std::size_t>(zi);
        float dz = std::clamp((z - scales_[at]) / (scales_[at + 1] - scales_[at]), 0.0f, 1.0f);
        int xi = std::min(static_cast<int>(x), resolution - 2),
            yi = std::min(static_cast<int>(y), resolution - 2);
        float dx = x - static_cast<float>(xi), dy = y - static_cast<float>(yi);
        Vec3d sum;
        for (int corner = 0; corner < 8; ++corner) {
            int cx = corner & 1, cy = corner >> 1 & 1, cz = corner >> 2;
            float weight = (cx ? dx : 1 - dx) * (cy ? dy : 1 - dy) * (cz ? dz : 1 - dz);
            sum += to_double(table_[index(i, zi + cz, yi + cy, xi + cx)]) * static_cast<double>(weight);
        }
        return sum;
    }

    Guess guess(Vec3d coefficients, const Lab& target) const {
        SigmoidColor color = quadrature_.color(to_float(coefficients));
        Lab lab = lab_of(xyz_from_rgb_ * color.rgb);
        Vec3d residual = lab.value - target.value;
        return {coefficients, color.rgb, residual, lab.by_xyz * xyz_from_rgb_ * color.by_coefficient,
                dot(residual, residual)};
    }

    static Vec3d step(const Guess& g, double damping) {
        Matrix3 jt = transposed(g.jacobian);
        Matrix3 normal = jt * g.jacobian;
        for (std::size_t i = 0; i < 3; ++i) normal.m[i][i] += damping * normal.m[i][i] + 1e-20;
        return -(normal.inverse() * (jt * g.residual));
    }

    /// From the given start; where that does not lead to the colour, from grey too.
    Vec3d best_of(Vec3d rgb, Vec3d start, int steps) const {
        Lab target = lab_of(xyz_from_rgb_ * rgb);
        Guess best = improve(guess(start, target), rgb, target, steps);
        if (largest(best.rgb - rgb) > good_enough) {
            auto mean = static_cast<float>((rgb.x + rgb.y + rgb.z) / 3);
            Guess grey = guess(to_double(SigmoidCoefficients::grey(std::clamp(mean, 0.01f, 0.99f))), target);
            Guess other = improve(grey, rgb, target, fit_steps);
            if (other.error < best.error) best = other;
        }
        return best.coefficients;
    }

    Guess improve(Guess best, Vec3d rgb, const Lab& target, int steps) const {
        double damping = 0;
        for (int i = 0; i < steps && largest(best.rgb - rgb) > good_enough; ++i) {
            Vec3d next = best.coefficients + step(best, damping);
            // Scaled as a whole, the polynomial keeps its roots, where the spectrum rises and falls.
            if (double most = largest(next); most > coefficient_limit) next *= coefficient_limit / most;
            Guess trial = guess(next, target);
            if (trial.error < best.error) {
                bool stalls = trial.error > 0.98 * best.error;
                best = trial;
                if (stalls) break;
                damping *= 0.2;
            } else {
                if (damping > 100) break;
                damping = std::max(10 * damping, 1e-3);
            }
        }
        return best;
    }

    SigmoidQuadrature quadrature_;
    Matrix3 xyz_from_rgb_;
    std::array<float, resolution> scales_{};
    std::vector<SigmoidCoefficients> table_; ///< by largest component, its value, and the other two over it
};

template <std::size_t index>
const Upsampler& upsampler() {
    static const Upsampler instance(*find_color_space(color_space_names().at(index)));
    return instance;
}

const Upsampler& upsampler_of(const RgbColorSpace& space) {
    const std::vector<std::string>& names = color_space_names();
    if (space.name == names[0]) return upsampler<0>();
    if (space.name == names[1]) return upsampler<1>();
    if (space.name == names[2]) return upsampler<2>();
    if (space.name == names[3]) return upsampler<3>();
    throw std::invalid_argument("no spectra are known for the colours of space \"" + space.name + "\"");
}

bool is_grey(Vec3 rgb) {
    return rgb.x == rgb.y && rgb.y == rgb.z;
}

Vec3 in_range(Vec3 rgb) {
    // Written so that NaN becomes 0.
    auto lane = [](float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; };
    return {lane(rgb.x), lane(rgb.y), lane(rgb.z)};
}

} // namespace

float SigmoidCoefficients::eval(float lambda) const {
    return eval(Spectrum(lambda))[0];
}

float SigmoidCoefficients::max_value() const {
    float most = std::max(eval(lambda_min), eval(lambda_max));
    if (c0 < 0) {
        float t = -c1 / (2 * c0);
        if (t > -1 && t < 1) most = std::max(most, eval(595 + 235 * t));
    }
    return most;
}

SigmoidCoefficients SigmoidCoefficients::grey(float value) {
    // At 1e6 the sigmoid is 0 or 1 to the last bit of a float.
    if (!(value > 0)) return {0, 0, -1e6f};
    if (value >= 1) return {0, 0, 1e6f};
    return {0, 0, (value - 0.5f) / std::sqrt(value * (1 - value))};
}

SigmoidCoefficients upsample(const RgbColorSpace& space, Vec3 rgb) {
    rgb = in_range(rgb);
    return is_grey(rgb) ? SigmoidCoefficients::grey(rgb.x) : upsampler_of(space).find(rgb);
}

} // namespace alhazen
