/// FLIP: the difference that a person sees who flips between two images (Andersson, Nilsson, Akenine-Moeller,
/// Oskarsson, Astrom and Fairchild 2020). Both images are blurred as the eye blurs fine colour detail,
/// compared in a uniform colour space, and the difference is raised where edges or points are in one image
/// only. Section numbers are the paper's.
#include <array>
#include <numbers>

#include "image/display.h"
#include "image/metrics.h"

namespace alhazen {

namespace {

/// CIE XYZ of linear sRGB (IEC 61966-2-1 primaries, D65), and back.
constexpr std::array<Vec3, 3> to_xyz{Vec3{0.41238656f, 0.35759149f, 0.18045049f},
                                     Vec3{0.21263682f, 0.71518298f, 0.07218020f},
                                     Vec3{0.01933062f, 0.11919716f, 0.95037259f}};
constexpr std::array<Vec3, 3> from_xyz{Vec3{3.24100326f, -1.53739899f, -0.49861587f},
                                       Vec3{-0.96922426f, 1.87592999f, 0.04155422f},
                                       Vec3{0.05563942f, -0.20401120f, 1.05714897f}};
/// XYZ of sRGB white.
constexpr Vec3 white{0.950428545f, 1.0f, 1.088900371f};

Vec3 multiply(const std::array<Vec3, 3>& m, Vec3 v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

/// YCxCz, a linear opponent space (section 4.1): lightness, red to green, blue to yellow.
Vec3 opponent_from_rgb(Vec3 rgb) {
    Vec3 xyz = multiply(to_xyz, rgb);
    float x = xyz.x / white.x, y = xyz.y / white.y, z = xyz.z / white.z;
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}
Vec3 rgb_from_opponent(Vec3 c) {
    float y = (c.x + 16) / 116;
    return multiply(from_xyz, {(c.y / 500 + y) * white.x, y * white.y, (y - c.z / 200) * white.z});
}

/// CIE L*a*b* with the Hunt effect: colours look stronger where it is brighter (section 4.2).
Vec3 hunt_lab_from_rgb(Vec3 rgb) {
    Vec3 xyz = multiply(to_xyz, rgb);
    auto f = [](float t) {
        constexpr float delta = 6.0f / 29;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29;
    };
    float fx = f(xyz.x / white.x), fy = f(xyz.y / white.y), fz = f(xyz.z / white.z);
    float lightness = 116 * fy - 16;
    return {lightness, 0.01f * lightness * 500 * (fx - fy), 0.01f * lightness * 200 * (fy - fz)};
}

/// City-block distance in lightness plus Euclidean distance in colour (Abasi et al. 2020).
float hyab(Vec3 a, Vec3 b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

using Planes = std::array<Plane, 3>;

Planes opponent_planes(const Image& image) {
    Plane empty(image.width(), image.height());
    Planes out{empty, empty, empty};
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            Vec3 c = image.rgb(x, y);
            // Through the display's curve and back: what is compared is the picture shown.
            for (int i = 0; i < 3; ++i) c[i] = std::isnan(c[i]) ? 0.0f : std::clamp(c[i], 0.0f, 1.0f);
            Vec3 opponent = opponent_from_rgb(c);
            for (int i = 0; i < 3; ++i) out[static_cast<std::size_t>(i)].at(x, y) = opponent[i];
        }
    return out;
}

/// a sqrt(pi / b) exp(-(pi d)^2 / b), d in degrees: a Gaussian in space for one in frequency (table 1).
struct Sensitivity {
    double a, b;
};
constexpr std::array<std::array<Sensitivity, 2>, 3> sensitivities{{
    {{{1, 0.0047}, {0, 1e-5}}},
    {{{1, 0.0053}, {0, 1e-5}}},
    {{{34.1, 0.04}, {13.5, 0.025}}},
}};

/// One of the three contrast sensitivity filters. A sum of two Gaussians is not separable, but each of them
/// is; the sum's weights are made to add up to one.
Plane filter_contrast(const Plane& in, const std::array<Sensitivity, 2>& sum, double pixels_per_degree) {
    constexpr double widest = 0.04; // all three filters have the radius of the widest
    int radius = static_cast<int>(
        std::ceil(3 * std::sqrt(widest / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree));
    std::array<std::vector<float>, 2> kernels;
    std::array<double, 2> weight{};
    for (std::size_t g = 0; g < 2; ++g) {
        std::vector<double> kernel;
        double total = 0;
        for (int i = -radius; i <= radius; ++i) {
            double d = std::numbers::pi * i / pixels_per_degree;
            kernel.push_back(std::exp(-d * d / sum[g].b));
            total += kernel.back();
        }
        for (double k : kernel) kernels[g].push_back(static_cast<float>(k / total));
        weight[g] = sum[g].a * std::sqrt(std::numbers::pi / sum[g].b) * total * total;
    }
    Plane out(in.width, in.height);
    for (std::size_t g = 0; g < 2; ++g) {
        if (weight[g] == 0) continue;
        Plane filtered = filter_separable(in, kernels[g], kernels[g], Border::clamp);
        auto w = static_cast<float>(weight[g] / (weight[0] + weight[1]));
        for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] += w * filtered.values[i];
    }
    return out;
}

/// The colour pipeline (section 4): filtered, in Hunt-adjusted L*a*b*.
std::vector<Vec3> perceived_colors(const Planes& opponent, double pixels_per_degree) {
    Planes filtered = opponent;
    for (std::size_t i = 0; i < 3; ++i)
        filtered[i] = filter_contrast(opponent[i], sensitivities[i], pixels_per_degree);
    std::vector<Vec3> out(filtered[0].values.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        Vec3 rgb = rgb_from_opponent({filtered[0].values[i], filtered[1].values[i], filtered[2].values[i]});
        out[i] = hunt_lab_from_rgb(min(max(rgb, Vec3{0.0f}), Vec3{1.0f}));
    }
    return out;
}

/// Compresses large colour differences, so that the result is 0 ... 1 (equation 3 of section 4.3).
float color_error(Vec3 a, Vec3 b, float largest) {
    constexpr float exponent = 0.7f, pc = 0.4f, pt = 0.95f;
    float error = std::pow(hyab(a, b), exponent);
    float knee = pc * largest;
    return error < knee ? pt / knee * error : pt + (error - knee) / (largest - knee) * (1 - pt);
}

/// Edges or points in lightness: derivatives of a Gaussian across x and across y, and how long the two
/// together are (section 5).
struct Features {
    std::vector<float> edges, points;
};

std::vector<float> lengths(const Plane& x, const Plane& y) {
    std::vector<float> out(x.values.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(x.values[i], y.values[i]);
    return out;
}

/// Positive weights scaled to add up to 1 and negative ones to -1.
std::vector<float> balanced(const std::vector<double>& kernel) {
    double positive = 0, negative = 0;
    for (double k : kernel) (k > 0 ? positive : negative) += std::abs(k);
    std::vector<float> out;
    for (double k : kernel) out.push_back(static_cast<float>(k / (k > 0 ? positive : negative)));
    return out;
}

Features find_features(const Plane& lightness, double pixels_per_degree) {
    constexpr double feature_width = 0.082; // degrees
    double sigma = 0.5 * feature_width * pixels_per_degree;
    int radius = static_cast<int>(std::ceil(3 * sigma));
    std::vector<double> gaussian, first, second;
    double total = 0;
    for (int i = -radius; i <= radius; ++i) {
        double g = std::exp(-i * i / (2 * sigma * sigma));
        gaussian.push_back(g);
        first.push_back(-i * g);
        second.push_back((i * i / (sigma * sigma) - 1) * g);
        total += g;
    }
    std::vector<float> blur;
    for (double g : gaussian) blur.push_back(static_cast<float>(g / total));
    std::vector<float> edge = balanced(first), point = balanced(second);
    Plane normalized = lightness;
    for (float& v : normalized.values) v = (v + 16) / 116;
    auto filter = [&](std::span<const float> h, std::span<const float> v) {
        return filter_separable(normalized, h, v, Border::clamp);
    };
    return {lengths(filter(edge, blur), filter(blur, edge)),
            lengths(filter(point, blur), filter(blur, point))};
}

} // namespace

MetricResult flip(const Image& a, const Image& b, const FlipOptions& options) {
    check_same_size(a, b);
    auto ppd = static_cast<double>(options.pixels_per_degree);
    Planes opponent_a = opponent_planes(a), opponent_b = opponent_planes(b);
    std::vector<Vec3> colors_a = perceived_colors(opponent_a, ppd),
                      colors_b = perceived_colors(opponent_b, ppd);
    Features features_a = find_features(opponent_a[0], ppd), features_b = find_features(opponent_b[0], ppd);
    // Green and blue are the farthest apart of all colours of a display.
    float largest = std::pow(hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1})), 0.7f);
    MetricResult result{0, Image::grey_image(a.width(), a.height())};
    double sum = 0;
    auto errors = result.error.values();
    for (std::size_t i = 0; i < errors.size(); ++i) {
        float color = color_error(colors_a[i], colors_b[i], largest);
        float feature = std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                                 std::abs(features_a.points[i] - features_b.points[i]));
        feature = std::sqrt(feature / std::numbers::sqrt2_v<float>);
        errors[i] = std::clamp(std::pow(color, 1 - std::min(feature, 1.0f)), 0.0f, 1.0f);
        sum += static_cast<double>(errors[i]);
    }
    result.value = sum / static_cast<double>(errors.size());
    return result;
}

} // namespace alhazen
