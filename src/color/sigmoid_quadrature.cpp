#include "color/sigmoid_quadrature.h"

#include <algorithm>

namespace alhazen {

SigmoidQuadrature::SigmoidQuadrature(const RgbColorSpace& space) {
    std::array<Vec3d, node_count> weights{};
    Vec3d white;
    for (int nm = 0; nm <= static_cast<int>(lambda_max - lambda_min); ++nm) {
        float lambda = lambda_min + static_cast<float>(nm);
        Vec3d xyz = Vec3d(cie_x().eval(lambda), cie_y().eval(lambda), cie_z().eval(lambda)) *
                    static_cast<double>(space.illuminant->eval(lambda));
        Vec3d rgb = space.rgb_from_xyz * xyz;
        white += rgb;
        spread(weights, nm, rgb);
    }
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        for (int lane = 0; lane < 4; ++lane) {
            std::size_t node = 4 * i + static_cast<std::size_t>(lane);
            float lambda = lambda_min + static_cast<float>(node * node_step);
            groups_[i].t.set(lane, (lambda - 595) * (1 / 235.0f));
            groups_[i].r.set(lane, static_cast<float>(weights[node].x / white.x));
            groups_[i].g.set(lane, static_cast<float>(weights[node].y / white.y));
            groups_[i].b.set(lane, static_cast<float>(weights[node].z / white.z));
        }
    }
}

void SigmoidQuadrature::spread(std::array<Vec3d, node_count>& weights, int nm, Vec3d rgb) {
    int first = std::clamp(nm / node_step - 1, 0, node_count - 4);
    double x = static_cast<double>(nm) / node_step - first;
    for (int i = 0; i < 4; ++i) {
        double lagrange = 1;
        for (int j = 0; j < 4; ++j) {
            if (j != i) lagrange *= (x - j) / (i - j);
        }
        weights[static_cast<std::size_t>(first + i)] += rgb * lagrange;
    }
}

Vec3d SigmoidQuadrature::rgb(SigmoidCoefficients c) const {
    Spectrum r(0), g(0), b(0);
    for (const Group& q : groups_) {
        Spectrum x = (c.c0 * q.t + c.c1) * q.t + c.c2;
        Spectrum value = 0.5f + 0.5f * x / sqrt(1.0f + x * x);
        r += q.r * value, g += q.g * value, b += q.b * value;
    }
    return {r.sum(), g.sum(), b.sum()};
}

SigmoidColor SigmoidQuadrature::color(SigmoidCoefficients c) const {
    Spectrum r(0), g(0), b(0), r0(0), r1(0), r2(0), g0(0), g1(0), g2(0), b0(0), b1(0), b2(0);
    for (const Group& q : groups_) {
        Spectrum x = (c.c0 * q.t + c.c1) * q.t + c.c2;
        Spectrum square = 1.0f + x * x;
        Spectrum inverse = 1.0f / sqrt(square);
        Spectrum value = 0.5f + 0.5f * x * inverse;
        Spectrum slope = 0.5f * inverse / square;
        Spectrum slope_t = slope * q.t, slope_tt = slope_t * q.t;
        r += q.r * value, g += q.g * value, b += q.b * value;
        r2 += q.r * slope, g2 += q.g * slope, b2 += q.b * slope;
        r1 += q.r * slope_t, g1 += q.g * slope_t, b1 += q.b * slope_t;
        r0 += q.r * slope_tt, g0 += q.g * slope_tt, b0 += q.b * slope_tt;
    }
    return {
        {r.sum(), g.sum(), b.sum()},
        {{{{r0.sum(), r1.sum(), r2.sum()}, {g0.sum(), g1.sum(), g2.sum()}, {b0.sum(), b1.sum(), b2.sum()}}}}};
}

SigmoidCurvature SigmoidQuadrature::curvature(SigmoidCoefficients c) const {
    SigmoidCurvature sums;
    for (const Group& q : groups_) {
        Spectrum x = (c.c0 * q.t + c.c1) * q.t + c.c2;
        Spectrum square = 1.0f + x * x;
        Spectrum bend = -1.5f * x / (square * square * sqrt(square));
        for (Vec3d& sum : sums) {
            sum += Vec3d((q.r * bend).sum(), (q.g * bend).sum(), (q.b * bend).sum());
            bend *= q.t;
        }
    }
    return sums;
}

} // namespace alhazen
