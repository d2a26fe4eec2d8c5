/// Hair and fur (Marschner et al. 2003; Chiang et al. 2016, "A practical and controllable hair and fur model
/// for production path tracing"; Pharr et al. 2023, section 9.9).
///
/// Picture a fibre as a glass cylinder, coloured inside, whose surface is covered by tilted scales. A ray
/// that meets it at the offset h from its axis is mirrored (lobe 0), goes through (1), comes back mirrored
/// once inside (2), or more often (the rest, all in lobe 3). Each lobe is a product: along the fibre
/// (longitudinal) a cone, blurred; around it (azimuthal) an angle, blurred; and how much light is left. x is
/// along the fibre, and angles around it are measured in the yz plane. There is no cosine with the surface's
/// normal, as the surface stands for the whole cylinder: eval().f, which has it in it, is the product itself.
///
/// The model is not quite symmetric: the loss of light is that of wo's path. Radiance has it as it is;
/// importance has the value of the way back, so that light followed from either end gives one picture.
#include <array>

#include <fmt/format.h>

#include "color/color_space.h"
#include "materials/fresnel.h"
#include "materials/material.h"
#include "math/special.h"

namespace alhazen {

namespace {

constexpr int lobe_count = 4;

struct Angle {
    float sine = 0, cosine = 1;
    Angle plus(Angle b) const {
        return {sine * b.cosine + cosine * b.sine, cosine * b.cosine - sine * b.sine};
    }
};
/// What a direction is along the fibre.
Angle along(Vec3 w) {
    return {w.x, safe_sqrt(1 - sqr(w.x))};
}
float around(Vec3 w) {
    return std::atan2(w.z, w.y);
}

/// Density over the sphere around the x axis of directions near the cone of angle o, of variance v (d'Eon et
/// al. 2011), but for the azimuth: exp(-b) I0(a) / (2 v sinh(1 / v)), a = cos cos / v, b = sin sin / v,
/// written so that nothing overflows.
float longitudinal(Angle o, Angle i, float v) {
    const float a = i.cosine * o.cosine / v, b = i.sine * o.sine / v;
    return std::exp(a - b - 1 / v) * bessel_i0_scaled(a) / (v * (1 - std::exp(-2 / v)));
}
Angle sample_longitudinal(Angle o, float v, Vec2 u) {
    const float cosine = 1 + v * std::log(std::max(u.x, 1e-5f) + (1 - u.x) * std::exp(-2 / v));
    const float sine = safe_sqrt(1 - sqr(cosine));
    const float s = std::clamp(-cosine * o.sine + sine * std::cos(2 * pi * u.y) * o.cosine, -1.0f, 1.0f);
    return {s, safe_sqrt(1 - sqr(s))};
}

/// The logistic distribution of the given scale, cut off at +-pi.
class TrimmedLogistic {
  public:
    explicit TrimmedLogistic(float scale) : scale_(scale), below_(cdf(-pi)) {}
    float density(float x) const {
        const float e = std::exp(-std::abs(x) / scale_);
        return e / (scale_ * sqr(1 + e)) / (1 - 2 * below_);
    }
    float sample(float u) const {
        const float p = below_ + u * (1 - 2 * below_);
        return std::clamp(-scale_ * std::log(1 / p - 1), -pi, pi);
    }

  private:
    float cdf(float x) const { return 1 / (1 + std::exp(-x / scale_)); }
    float scale_, below_;
};

/// phi in -pi ... pi.
float wrapped(float phi) {
    return std::remainder(phi, 2 * pi);
}

/// What a fibre is at one place.
struct Fibre {
    float h = 0; ///< offset from the axis, -1 ... 1
    float eta = 1.55f;
    Spectrum sigma_a = 0; ///< absorption per radius
    float beta_m = 0.3f, beta_n = 0.3f;
    float alpha = 2; ///< tilt of the scales, in degrees
};

struct HairBsdf final : Bsdf {
    explicit HairBsdf(const Fibre& fibre) : fibre_(fibre), azimuthal_(azimuthal_scale(fibre.beta_n)) {
        // Fitted so that roughness looks even to the eye (Chiang et al. 2016, equations 7 and 8).
        const float m = fibre.beta_m, m2 = m * m, m4 = sqr(m2), m16 = sqr(sqr(m4));
        const float v = sqr(0.726f * m + 0.812f * m2 + 3.7f * m16 * m4);
        variance_ = {v, 0.25f * v, 4 * v, 4 * v};
        gamma_o_ = std::asin(fibre.h);
        // Scales tilt the lobes by -2, 1 and 4 times alpha.
        const float a = radians(fibre.alpha);
        for (std::size_t p = 0; p < 3; ++p) {
            constexpr std::array times{-2.0f, 1.0f, 4.0f};
            tilt_[p] = {std::sin(times[p] * a), std::cos(times[p] * a)};
        }
    }

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode) const override {
        if (wo.z == 0 || wi.z == 0) return {};
        const Value there = value(from(wo), wi), back = value(from(wi), wo);
        if (mode == TransportMode::radiance) return {there.f, there.pdf, back.pdf};
        return {back.f * std::abs(wi.z / wo.z), there.pdf, back.pdf};
    }

    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode) const override {
        if (wo.z == 0) return std::nullopt;
        const From o = from(wo);
        std::size_t p = 0;
        for (; p < lobe_count - 1 && u >= o.lobes[p].chance; ++p) u -= o.lobes[p].chance;
        u = std::min(u / o.lobes[p].chance, one_minus_epsilon);
        const Angle theta = sample_longitudinal(o.lobes[p].theta, variance_[p], u2);
        const float turn = p < 3 ? turn_of(p, o.gamma_t) + azimuthal_.sample(u) : 2 * pi * u;
        const Vec3 wi = normalize(
            Vec3(theta.sine, theta.cosine * std::cos(o.phi + turn), theta.cosine * std::sin(o.phi + turn)));
        const Scatter s = eval(wo, wi, mode);
        if (!(s.pdf > 0)) return std::nullopt;
        const Lobes side = same_hemisphere(wo, wi) ? Lobes::reflection : Lobes::transmission;
        return BsdfSample{wi, s.f, s.pdf, s.pdf_reverse, side | Lobes::glossy, 1};
    }

    Lobes lobes() const override { return Lobes::reflection | Lobes::transmission | Lobes::glossy; }
    void regularize() override {}

  private:
    struct Lobe {
        Spectrum left; ///< fraction of light that takes this way
        float chance = 0;
        Angle theta; ///< the cone's, tilted
    };
    /// What of a value is the same for all wi.
    struct From {
        float phi = 0, gamma_t = 0;
        std::array<Lobe, lobe_count> lobes;
    };
    struct Value {
        Spectrum f = 0;
        float pdf = 0;
    };

    static float azimuthal_scale(float n) {
        const float n2 = n * n, n4 = sqr(n2), n16 = sqr(sqr(n4));
        return std::sqrt(pi / 8) * (0.265f * n + 1.194f * n2 + 5.372f * n16 * n4 * n2);
    }

    From from(Vec3 wo) const {
        From o;
        const Angle theta = along(wo);
        o.phi = around(wo);
        // A ray at an angle sees the cross section as if of a larger index (Bravais 1850).
        const float sin_gamma_t =
            std::clamp(fibre_.h * theta.cosine / safe_sqrt(sqr(fibre_.eta) - sqr(theta.sine)), -1.0f, 1.0f);
        o.gamma_t = std::asin(sin_gamma_t);
        const float cos_theta_t = safe_sqrt(1 - sqr(theta.sine / fibre_.eta));
        const Spectrum through = exp(-fibre_.sigma_a * (2 * safe_sqrt(1 - sqr(sin_gamma_t)) / cos_theta_t));
        set_losses(o, theta.cosine * safe_sqrt(1 - sqr(fibre_.h)), through);
        for (std::size_t p = 0; p < 3; ++p) {
            o.lobes[p].theta = theta.plus(tilt_[p]);
            o.lobes[p].theta.cosine = std::abs(o.lobes[p].theta.cosine);
        }
        o.lobes[3].theta = theta;
        return o;
    }

    // cosine: of the ray with the cylinder's normal; through: what is left of light after one way through.
    void set_losses(From& o, float cosine, Spectrum through) const {
        const float mirrored = fresnel_dielectric(cosine, fibre_.eta);
        o.lobes[0].left = mirrored;
        o.lobes[1].left = sqr(1 - mirrored) * through;
        o.lobes[2].left = o.lobes[1].left * through * mirrored;
        // A geometric series; where all is mirrored, nothing has entered.
        const Spectrum ratio = through * mirrored;
        o.lobes[3].left = mirrored < 1 ? o.lobes[2].left * ratio / (1 - ratio) : 0;
        float sum = 0;
        for (const Lobe& lobe : o.lobes) sum += lobe.left.average();
        for (Lobe& lobe : o.lobes) lobe.chance = lobe.left.average() / sum;
    }

    // By how much the lobe's ray is turned around the fibre.
    float turn_of(std::size_t p, float gamma_t) const {
        return 2 * static_cast<float>(p) * gamma_t - 2 * gamma_o_ + static_cast<float>(p) * pi;
    }

    Value value(const From& o, Vec3 wi) const {
        const Angle theta = along(wi);
        const float phi = around(wi) - o.phi;
        Value sum;
        for (std::size_t p = 0; p < lobe_count; ++p) {
            const Lobe& lobe = o.lobes[p];
            const float turned =
                p < 3 ? azimuthal_.density(wrapped(phi - turn_of(p, o.gamma_t))) : inv_pi / 2;
            const float density = longitudinal(lobe.theta, theta, variance_[p]) * turned;
            sum.f += lobe.left * density;
            sum.pdf += lobe.chance * density;
        }
        return sum;
    }

    Fibre fibre_;
    TrimmedLogistic azimuthal_;
    float gamma_o_;
    std::array<float, lobe_count> variance_;
    std::array<Angle, 3> tilt_;
};

struct Hair final : Material {
    std::optional<UnboundedTexture> sigma_a;
    std::optional<AlbedoTexture> reflectance, color;
    std::optional<FloatTexture> eumelanin, pheomelanin;
    FloatTexture eta{1.55f}, beta_m{0.3f}, beta_n{0.3f}, alpha{2};

    static void describe(Fields<Hair>& f) {
        f.about("Hair and fur, for curves. Its colour comes from sigma_a, or else from the reflectance, or "
                "else from "
                "pigments; without any of them it is brown.");
        f.field("sigma_a", &Hair::sigma_a, "absorption inside the fibre").unit("per radius");
        f.field("reflectance", &Hair::reflectance, "colour of a mass of such hair").in(0, 1);
        f.field("color", &Hair::color, "an older name of reflectance").in(0, 1);
        f.field("eumelanin", &Hair::eumelanin, "concentration of the pigment that makes hair brown and black")
            .at_least(0)
            .otherwise("1.3, unless a colour is given");
        f.field("pheomelanin", &Hair::pheomelanin,
                "concentration of the pigment that makes hair yellow and red")
            .at_least(0);
        f.field("eta", &Hair::eta, "index of refraction of the fibre").at_least(1);
        f.field("beta_m", &Hair::beta_m, "roughness along the fibre").in(0, 1);
        f.field("beta_n", &Hair::beta_n, "roughness around the fibre").in(0, 1);
        f.field("alpha", &Hair::alpha, "tilt of the scales on the fibre").unit("degrees");
        f.example("brown", {});
        f.example("red", {make_float("pheomelanin", 2.5f), make_float("eumelanin", 0.2f),
                          make_float("beta_m", 0.2f)});
        f.example("dyed", {make_rgb("reflectance", 0.2f, 0.4f, 0.8f), make_float("beta_m", 0.5f),
                           make_float("beta_n", 0.6f), make_float("alpha", 5)});
        f.example("white",
                  {make_float("sigma_a", 0), make_float("beta_m", 0.7f), make_float("beta_n", 0.9f)});
        f.example("fine", {make_rgb("sigma_a", 0.2f, 0.5f, 1.2f), make_float("beta_m", 0.15f),
                           make_float("beta_n", 0.2f), make_float("eta", 1.4f)});
        f.example("coarse",
                  {make_rgb("color", 0.9f, 0.7f, 0.4f), make_float("beta_m", 1), make_float("beta_n", 1)});
    }

    void finish(const Node& node, BuildContext& context) {
        if (!reflectance) reflectance = color;
        auto ignore = [&](std::string_view name, std::string_view stronger) {
            if (const Parameter* p = node.find(name))
                context.messages.add_warning(
                    p->place, fmt::format("\"{}\" is ignored, since \"{}\" is given too", name, stronger));
        };
        const bool has_pigments = eumelanin || pheomelanin;
        if (sigma_a && reflectance) ignore(node.find("reflectance") ? "reflectance" : "color", "sigma_a");
        if ((sigma_a || reflectance) && has_pigments)
            ignore(eumelanin ? "eumelanin" : "pheomelanin", sigma_a ? "sigma_a" : "reflectance");
        if (!sigma_a && !reflectance && !has_pigments) eumelanin = FloatTexture(1.3f);
        auto is_even = [](const std::optional<FloatTexture>& pigment) {
            return !pigment || pigment->is_constant();
        };
        if (is_even(eumelanin) && is_even(pheomelanin)) even_pigments_ = pigments(TexturePoint({}, {}, {}));
    }

    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        const TexturePoint at(hit);
        Fibre fibre;
        // v runs across the curve.
        fibre.h = std::clamp(2 * hit.uv.y - 1, -1.0f, 1.0f);
        fibre.eta = std::max(eta.eval(at), 1.0f);
        fibre.beta_m = std::clamp(beta_m.eval(at), smallest_beta, 1.0f);
        fibre.beta_n = std::clamp(beta_n.eval(at), smallest_beta, 1.0f);
        fibre.alpha = alpha.eval(at);
        fibre.sigma_a = absorption(at, fibre.beta_n, lambda);
        return arena.make<HairBsdf>(fibre);
    }

  private:
    static constexpr float smallest_beta = 0.01f;

    Spectrum absorption(const TexturePoint& at, float n, const Wavelengths& lambda) const {
        if (sigma_a) return clamp(sigma_a->eval(at, lambda), 0, infinity);
        if (reflectance) {
            // Fitted to how a mass of hair looks (Chiang et al. 2016, equation 9).
            const float fit =
                5.969f + n * (-0.215f + n * (2.532f + n * (-10.73f + n * (5.574f + n * 0.245f))));
            return map(reflectance->eval(at, lambda),
                       [&](float c) { return sqr(std::log(std::clamp(c, 1e-6f, 1.0f)) / fit); });
        }
        return (even_pigments_ ? *even_pigments_ : pigments(at)).eval(lambda);
    }
    // Absorption of the two pigments (d'Eon et al. 2011).
    SpectrumValue pigments(const TexturePoint& at) const {
        auto amount = [&](const std::optional<FloatTexture>& pigment) {
            return pigment ? std::max(0.0f, pigment->eval(at)) : 0;
        };
        return SpectrumValue::unbounded_rgb(srgb_space(),
                                            Vec3(0.419f, 0.697f, 1.37f) * amount(eumelanin) +
                                                Vec3(0.187f, 0.4f, 1.05f) * amount(pheomelanin));
    }

    std::optional<SpectrumValue> even_pigments_; ///< where they are the same everywhere: fitting takes time
};

} // namespace

Kind<Material> hair_material() {
    return make_kind<Material, Hair>("hair");
}

} // namespace alhazen
