/// Writes src/color/data/visible_density.inl: the density that a path's wavelengths are drawn from.
///
/// A path carries four wavelengths, a quarter of the density's integral apart, and a sensor adds up what each
/// brings over its density. For which light that sum errs least depends on the density. This one is found so
/// that for light as scenes have it the four together measure red, green and blue almost without error: what
/// is minimised is the mean variance of the measurement, relative to the square of its mean, over the
/// ColorChecker's 24 swatches under daylight, equal energy, incandescent and fluorescent light. The numbers
/// are committed; this is run only to change them (with another compiler or mathematical library the search
/// may end at others that are as good):
///     g++ -O2 -std=c++20 -Isrc tools/fit_wavelengths.cpp -o fit && ./fit >
///     src/color/data/visible_density.inl
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace {

constexpr float observer[] = {
#include "color/data/cie_1931.inl"
};
constexpr float swatches[] = {
#include "color/data/color_checker.inl"
};
constexpr float daylight[] = {
#include "color/data/illuminant_d65.inl"
};
constexpr float fluorescent[] = {
#include "color/data/illuminant_f2.inl"
};

constexpr int first = 360, count = 471, node_step = 10, nodes = (count - 1) / node_step + 1;
constexpr int swatch_first = 380, swatch_step = 10, swatch_values = 36, swatch_count = 24;
constexpr int light_step = 5;
using Curve = std::array<double, count>;
using Density = std::array<double, nodes>;

template <class Table>
double at(const Table& table, int offset, int values, double place) {
    const double x = std::clamp(place, 0.0, values - 1.0);
    const int i = std::min(static_cast<int>(x), values - 2);
    return table[offset + i] + (x - i) * (table[offset + i + 1] - table[offset + i]);
}

/// Of a light on a swatch: what it brings to linear sRGB's red, green and blue at each nm.
using Stimulus = std::array<Curve, 3>;

std::vector<Stimulus> stimuli() {
    constexpr double rgb_of_xyz[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                         {-0.9692660, 1.8760108, 0.0415560},
                                         {0.0556434, -0.2040259, 1.0572252}};
    std::vector<Stimulus> all;
    for (int light = 0; light < 4; ++light)
        for (int swatch = 0; swatch < swatch_count; ++swatch) {
            Stimulus& stimulus = all.emplace_back();
            for (int i = 0; i < count; ++i) {
                const double lambda = first + i, light_place = static_cast<double>(i) / light_step;
                const double planck = 1e12 / std::pow(lambda, 5) / (std::exp(1.4388e7 / (lambda * 2856)) - 1);
                const double powers[] = {at(daylight, 0, 95, light_place), 1, planck,
                                         at(fluorescent, 0, 95, light_place)};
                const double reflected = powers[light] * at(swatches, swatch * swatch_values, swatch_values,
                                                            (lambda - swatch_first) / swatch_step);
                for (std::size_t c = 0; c < 3; ++c)
                    for (int k = 0; k < 3; ++k)
                        stimulus[c][static_cast<std::size_t>(i)] +=
                            reflected * rgb_of_xyz[c][k] * observer[3 * i + k];
            }
        }
    return all;
}

struct Error {
    double four, one; ///< relative variances with four wavelengths, and with one (after dispersion)
};

Error error_of(const Density& density, const std::vector<Stimulus>& all) {
    constexpr int steps = 250; // of a quarter
    Curve p;
    double sum = 0;
    for (int i = 0; i < count; ++i)
        sum += p[static_cast<std::size_t>(i)] = at(density, 0, nodes, static_cast<double>(i) / node_step);
    std::vector<std::size_t> drawn;
    double below = 0;
    std::size_t at_nm = 0;
    for (int j = 0; j < 4 * steps; ++j) {
        while (at_nm + 1 < count && below + p[at_nm] < (j + 0.5) / (4 * steps) * sum) below += p[at_nm++];
        drawn.push_back(at_nm);
    }
    Error error{};
    for (const Stimulus& stimulus : all) {
        double grey = 0;
        std::array<double, 3> mean{}, four{}, one{};
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t j = 0; j < steps; ++j) {
                double partners = 0;
                for (std::size_t k = 0; k < 4; ++k) {
                    const std::size_t i = drawn[j + k * steps];
                    const double value = stimulus[c][i] / p[i];
                    partners += value / 4;
                    one[c] += value * value / (4 * steps);
                }
                mean[c] += partners / steps;
                four[c] += partners * partners / steps;
            }
            grey += mean[c] / 3;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            // What is wrong with a channel of which there is next to nothing does not count.
            const double shown = std::max(mean[c], 0.3 * grey),
                         all_channels = 3 * static_cast<double>(all.size());
            error.four += (four[c] - mean[c] * mean[c]) / (shown * shown) / all_channels;
            error.one += (one[c] - mean[c] * mean[c]) / (shown * shown) / all_channels;
        }
    }
    return error;
}

double cost(const Density& density, const std::vector<Stimulus>& all) {
    const Error e = error_of(density, all);
    return e.four + 0.002 * e.one;
}

/// Not less than this everywhere: that no wavelength that is seen at all counts too much when it is drawn.
Density least() {
    Density d;
    for (int k = 0; k < nodes; ++k) {
        const int i = 3 * k * node_step;
        d[static_cast<std::size_t>(k)] = 1e-5 + 4e-4 * (observer[i] + observer[i + 1] + observer[i + 2]);
    }
    return d;
}

Density fitted(const std::vector<Stimulus>& all) {
    const Density lowest = least();
    Density best;
    for (int k = 0; k < nodes; ++k)
        best[static_cast<std::size_t>(k)] =
            std::pow(std::cosh(0.0072 * (first + node_step * k - 538)), -2) / 254;
    double least_cost = cost(best, all);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    double step = 0.3;
    constexpr int tries = 60000, round = 10000;
    for (int i = 1; i <= tries; ++i) {
        Density changed = best;
        const int middle = static_cast<int>(random() % nodes), width = static_cast<int>(random() % 6);
        const double change = normal(random) * step;
        double sum = 0;
        for (int k = 0; k < nodes; ++k) {
            double& d = changed[static_cast<std::size_t>(k)];
            d *= std::exp(change * std::max(0.0, 1 - std::abs(k - middle) / (width + 1.0)));
            sum += d * node_step * (k == 0 || k == nodes - 1 ? 0.5 : 1);
        }
        for (std::size_t k = 0; k < nodes; ++k) changed[k] = std::max(changed[k] / sum, lowest[k]);
        if (const double c = cost(changed, all); c < least_cost) {
            least_cost = c;
            best = changed;
        }
        if (i % round == 0) {
            step *= 0.7;
            const Error e = error_of(best, all);
            std::fprintf(stderr, "%d: variances %.5f with four, %.3f with one\n", i, e.four, e.one);
        }
    }
    return best;
}

} // namespace

int main() {
    const std::vector<Stimulus> all = stimuli();
    Density start;
    for (int k = 0; k < nodes; ++k)
        start[static_cast<std::size_t>(k)] = std::pow(std::cosh(0.0072 * (first + node_step * k - 538)), -2);
    const Error before = error_of(start, all);
    std::fprintf(stderr, "after Pharr et al. 2023: variances %.5f with four, %.3f with one\n", before.four,
                 before.one);
    const Density density = fitted(all);
    std::printf("// Density of wavelengths at 360 to 830 nm by 10 nm, linear between, up to a factor.\n"
                "// Written by tools/fit_wavelengths.cpp.\n");
    for (std::size_t k = 0; k < nodes; ++k)
        std::printf("%.5ff,%s", 1000 * density[k], k % 10 == 9 || k + 1 == nodes ? "\n" : " ");
}
