/// What lights without size share: an intensity, perhaps scaled to a given flux, at a point (Pharr et al.
/// 2023, section 12.2).
#pragma once

#include "lights/light.h"
#include "lights/light_parts.h"

namespace alhazen {

struct PointLike : Light {
    IlluminantSpectrum I = white_light();
    float scale = 1;
    std::optional<float> power_target;
    Vec3 from{0, 0, 0};

    bool is_delta() const override { return true; }
    Spectrum power(const Wavelengths& lambda) const override {
        return intensity_.eval(lambda) * solid_angle_;
    }

  protected:
    template <class T>
    static void describe_point_like(Fields<T>& f, std::string meaning_of_I) {
        f.field("I", &T::I, std::move(meaning_of_I)).unit("W/sr");
        f.field("scale", &T::scale, "factor on the intensity").at_least(0);
        f.field("power", &T::power_target, "luminous flux; when positive, the intensity is scaled to give it")
            .unit("lm");
    }
    template <class T>
    static void describe_from(Fields<T>& f) {
        f.field("from", &T::from, "where the light is").unit("scene units");
    }
    /// solid_angle: integral over all directions of what sample_point's factor is made of, without the
    /// distance; steradians.
    void place(float solid_angle, const Node& node, const BuildContext& context) {
        take_default_color(node, "I", I);
        solid_angle_ = solid_angle;
        float s = scale;
        if (is_given(power_target)) s *= solid_angle > 0 ? *power_target / solid_angle : 0.0f;
        intensity_ = calibrated(I.value, s, context.color_mode);
        p_ = context.world_from_node.point(from);
    }
    /// The intensity times factor(direction towards the light).
    template <class Factor>
    std::optional<LightSample> sample_point(const LightReceiver& at, const Wavelengths& lambda,
                                            Factor factor) const {
        auto to_light = direction_between(at.p, p_);
        if (!to_light) return std::nullopt;
        LightSample s;
        s.L = intensity_.eval(lambda) * factor(*to_light);
        if (s.L.is_black()) return std::nullopt;
        s.wi = to_light->w;
        s.pdf = 1;
        s.p = p_;
        return s;
    }
    /// Light along w (unit, drawn with the density), the intensity times the factor.
    std::optional<LeavingLight> leave_point(Vec3 w, float factor, float pdf, const Wavelengths& lambda,
                                            float time) const {
        LeavingLight s;
        s.L = intensity_.eval(lambda) * factor;
        if (s.L.is_black() || !(pdf > 0)) return std::nullopt;
        s.ray = {p_, w, infinity, time};
        s.pdf_position = 1;
        s.pdf_direction = pdf;
        s.p = p_;
        return s;
    }
    Vec3 position() const { return p_; }
    Spectrum intensity(const Wavelengths& lambda) const { return intensity_.eval(lambda); }
    /// For a light that shines everywhere.
    LightBounds point_bounds() const {
        LightBounds b;
        b.bounds = {p_, p_};
        b.power = 4 * pi * brightness(intensity_);
        return b;
    }

  private:
    SpectrumValue intensity_;
    Vec3 p_;
    float solid_angle_ = 4 * pi;
};

} // namespace alhazen
