#include "materials/coat.h"

namespace alhazen {

namespace {

// The digits of i in the given base, mirrored at the point (van der Corput 1935): numbers that fill [0, 1)
// evenly.
float radical_inverse(int i, int base) {
    float sum = 0, digit = 1;
    for (; i > 0; i /= base) sum += static_cast<float>(i % base) * (digit /= static_cast<float>(base));
    return std::min(sum, one_minus_epsilon);
}
Vec2 spread(int i) {
    return {radical_inverse(i, 2), radical_inverse(i, 3)};
}

Vec3 direction_of(float cosine) {
    return {safe_sqrt(1 - sqr(cosine)), 0, cosine};
}

} // namespace

Coat::Coat(float eta, float thickness, std::optional<float> alpha) : eta_(eta), thickness_(thickness) {
    if (alpha) {
        rows_.push_back(make_row(*alpha));
        return;
    }
    for (int i = 0; i <= alphas; ++i) rows_.push_back(make_row(sqr(static_cast<float>(i) / alphas)));
}

float Coat::let_in_smooth(float cosine) const {
    auto in = refract(direction_of(cosine), {0, 0, 1}, eta_);
    if (!in || in->wt.z == 0) return 0;
    return (1 - (eta_ == 1 ? 0 : fresnel_dielectric(cosine, eta_))) * through(in->wt);
}

// Means over evenly spread facets and directions. Cosines are denser towards grazing directions, where what
// is let in falls to nothing.
Coat::Row Coat::make_row(float alpha) const {
    constexpr int facets = 256, ways = 4096;
    const DielectricBsdf border({alpha, alpha}, eta_);
    // Fraction of w's light that the border sends down and that crosses the layer.
    auto sent_down = [&](Vec3 w, Vec2 u, Sides sides) {
        auto s = border.sample(w, 0.5f, u, TransportMode::importance, sides);
        return s && s->wi.z < 0 ? s->f[0] / s->pdf * through(s->wi) : 0.0f;
    };
    Row row{.alpha = alpha};
    for (int c = 1; c < cosines; ++c) {
        const Vec3 w = direction_of(sqr(static_cast<float>(c) / (cosines - 1)));
        double sum = 0;
        for (int i = 0; i < facets; ++i) sum += static_cast<double>(sent_down(w, spread(i), Sides::across));
        row.let_in[static_cast<std::size_t>(c)] = static_cast<float>(sum / facets);
    }
    Place place{.coat = this};
    if (!border.is_specular()) place.smoother = place.rougher = row.let_in.data();
    double back = 0, in = 0;
    for (int i = 0; i < ways; ++i) {
        // Of matte light, the squared cosines are uniform.
        const float cosine = std::sqrt((static_cast<float>(i) + 0.5f) / ways);
        const Vec3 down = -direction_of(cosine);
        back += static_cast<double>(through(down) * sent_down(down, spread(i), Sides::same));
        in += static_cast<double>(place.let_in(cosine));
    }
    row.sent_back = static_cast<float>(back / ways);
    // What leaves is the way back of what enters, in a solid angle eta^2 as wide.
    row.let_out = static_cast<float>(in / ways) / sqr(eta_);
    return row;
}

float Coat::Place::let_in(float cosine) const {
    if (!smoother) return coat->let_in_smooth(cosine);
    const float x = std::sqrt(std::min(cosine, 1.0f)) * (cosines - 1);
    const auto i = std::min(static_cast<std::size_t>(x), std::size_t{cosines - 2});
    const float f = x - static_cast<float>(i);
    return lerp(t, lerp(f, smoother[i], smoother[i + 1]), lerp(f, rougher[i], rougher[i + 1]));
}

Coat::Place Coat::at(float alpha) const {
    if (rows_.size() == 1) return between(rows_[0], rows_[0], 0);
    const float x = std::sqrt(std::clamp(alpha, 0.0f, largest_alpha)) * alphas;
    const auto i = std::min(static_cast<std::size_t>(x), std::size_t{alphas - 1});
    return between(rows_[i], rows_[i + 1], x - static_cast<float>(i));
}

Coat::Place Coat::between(const Row& a, const Row& b, float t) const {
    Place place{.coat = this, .t = t};
    place.sent_back = lerp(t, a.sent_back, b.sent_back);
    place.let_out = lerp(t, a.let_out, b.let_out);
    if (!DielectricBsdf({b.alpha, b.alpha}, eta_).is_specular()) {
        place.smoother = a.let_in.data();
        place.rougher = b.let_in.data();
    }
    return place;
}

} // namespace alhazen
