/// Matte points lit many at a time.
#include "raster/shading.h"

namespace alhazen {

namespace {

/// The light that arrives at the points of a batch, times the cosines.
class MatteLighting {
  public:
    MatteLighting(RasterPoints& batch, const LightVisibility* visibility, const RasterKernel& kernel)
        : batch_(batch), visibility_(visibility), kernel_(kernel) {}

    void add_everywhere(Spectrum irradiance) {
        part_.fill(1);
        add_part(irradiance);
    }
    void add_surroundings(const RadianceHarmonics& surroundings) {
        for (std::size_t i = 0; i < batch_.count; ++i) add(i, surroundings.irradiance(normal(i)));
    }
    void add_light(const LocalLight& light, std::size_t number) {
        if (light.kind() == LocalLight::Kind::asked) return add_asked(light, number);
        kernel_.light(light.numbers(), batch_, part_.data());
        const bool is_distant = light.kind() == LocalLight::Kind::distant;
        for (std::size_t i = 0; visibility_ && i < batch_.count; ++i)
            if (part_[i] > 0)
                part_[i] *=
                    lit(i, number, is_distant ? light.direction() : normalize(light.position() - point(i)));
        add_part(light.radiance());
    }
    /// Turns the batch's BSDFs into light sent to the eye.
    void finish() {
        for (std::size_t i = 0; i < batch_.count; ++i) {
            batch_.red[i] *= red_[i];
            batch_.green[i] *= green_[i];
            batch_.blue[i] *= blue_[i];
        }
    }

  private:
    Vec3 point(std::size_t i) const { return {batch_.px[i], batch_.py[i], batch_.pz[i]}; }
    Vec3 normal(std::size_t i) const { return {batch_.nx[i], batch_.ny[i], batch_.nz[i]}; }
    float lit(std::size_t i, std::size_t light, Vec3 wi) const {
        return visibility_->lit(point(i), {batch_.gx[i], batch_.gy[i], batch_.gz[i]}, light, wi);
    }

    void add_asked(const LocalLight& light, std::size_t number) {
        for (std::size_t i = 0; i < batch_.count; ++i) {
            const auto arriving = light.at(point(i));
            const float cosine = arriving ? dot(arriving->wi, normal(i)) : 0;
            if (!(cosine > 0)) continue;
            add(i, arriving->irradiance * (visibility_ ? cosine * lit(i, number, arriving->wi) : cosine));
        }
    }

    void add(std::size_t i, Spectrum irradiance) {
        red_[i] += irradiance[0];
        green_[i] += irradiance[1];
        blue_[i] += irradiance[2];
    }
    void add_part(Spectrum light) {
        const float r = light[0], g = light[1], b = light[2];
        for (std::size_t i = 0; i < batch_.count; ++i) {
            red_[i] += part_[i] * r;
            green_[i] += part_[i] * g;
            blue_[i] += part_[i] * b;
        }
    }

    RasterPoints& batch_;
    const LightVisibility* visibility_;
    const RasterKernel& kernel_;
    alignas(64) std::array<float, RasterPoints::capacity> part_; ///< of one light, before its colour
    alignas(64) std::array<float, RasterPoints::capacity> red_{}, green_{}, blue_{};
};

} // namespace

void LocalShading::light(RasterPoints& batch) const {
    MatteLighting lighting(batch, visibility_, kernel_);
    lighting.add_everywhere(options_.ambient * pi);
    if (!lights_.surroundings.is_black()) lighting.add_surroundings(lights_.surroundings);
    for (std::size_t i = 0; i < lights_.lights.size(); ++i) lighting.add_light(lights_.lights[i], i);
    lighting.finish();
}

} // namespace alhazen
