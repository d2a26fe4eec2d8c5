/// Matte points lit many at a time: loops over arrays of numbers, which compilers turn into vector
/// instructions.
#include "raster/shading.h"

namespace alhazen {

namespace {

/// The light that arrives at the points of a batch, times the cosines.
class MatteLighting {
  public:
    MatteLighting(MatteBatch& batch, const LightVisibility* visibility)
        : batch_(batch), visibility_(visibility) {}

    void add_everywhere(Spectrum irradiance) {
        part_.fill(1);
        add_part(irradiance);
    }
    void add_surroundings(const RadianceHarmonics& surroundings) {
        for (std::size_t i = 0; i < batch_.count; ++i) add(i, surroundings.irradiance(normal(i)));
    }
    void add_light(const LocalLight& light, std::size_t number) {
        if (light.kind() == LocalLight::Kind::asked) return add_asked(light, number);
        const LocalLight::Numbers numbers = light.numbers();
        const bool is_distant = light.kind() == LocalLight::Kind::distant;
        if (is_distant)
            distant(numbers.normal);
        else
            near(numbers);
        for (std::size_t i = 0; visibility_ && i < batch_.count; ++i)
            if (part_[i] > 0)
                part_[i] *= lit(i, number, is_distant ? numbers.normal : normalize(numbers.p - point(i)));
        add_part(numbers.radiance);
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

    // See LocalLight::at.
    void near(const LocalLight::Numbers& light) {
        for (std::size_t i = 0; i < batch_.count; ++i) {
            const float dx = light.p.x - batch_.px[i], dy = light.p.y - batch_.py[i],
                        dz = light.p.z - batch_.pz[i];
            const float d2 = dx * dx + dy * dy + dz * dz;
            const float received = dx * batch_.nx[i] + dy * batch_.ny[i] + dz * batch_.nz[i];
            const float along = -(dx * light.normal.x + dy * light.normal.y + dz * light.normal.z);
            const float inverse = 1 / std::sqrt(d2);
            // A round light sends the same to all sides; of a flat one's back nothing comes.
            const float sent =
                light.is_flat ? (light.is_two_sided ? std::abs(along) : along) * inverse : 1.0f;
            const float value = received * inverse * sent * light.area / (d2 + light.area * inv_pi);
            part_[i] = received > 0 && sent > 0 ? value : 0.0f;
        }
    }
    void distant(Vec3 wi) {
        for (std::size_t i = 0; i < batch_.count; ++i)
            part_[i] = std::max(0.0f, wi.x * batch_.nx[i] + wi.y * batch_.ny[i] + wi.z * batch_.nz[i]);
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

    MatteBatch& batch_;
    const LightVisibility* visibility_;
    alignas(64) MatteBatch::Array part_; ///< of one light, before its colour
    alignas(64) MatteBatch::Array red_{}, green_{}, blue_{};
};

} // namespace

void LocalShading::light(MatteBatch& batch) const {
    MatteLighting lighting(batch, visibility_);
    lighting.add_everywhere(options_.ambient * pi);
    if (!lights_.surroundings.is_black()) lighting.add_surroundings(lights_.surroundings);
    for (std::size_t i = 0; i < lights_.lights.size(); ++i) lighting.add_light(lights_.lights[i], i);
    lighting.finish();
}

} // namespace alhazen
