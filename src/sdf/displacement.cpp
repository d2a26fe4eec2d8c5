/// Displacement: a body's surface moved outward by a texture (Cook 1984).
#include <fmt/format.h>

#include "base/hash.h"
#include "sdf/placed_sdf.h"
#include "textures/texture.h"

namespace alhazen {

namespace {

struct DisplacementSdf final : SdfOf<DisplacementSdf> {
    SdfChild child;
    FloatTexture texture{0.0f};
    float amplitude = 0.1f;
    std::optional<float> slope;

    static void describe(Fields<DisplacementSdf>& f) {
        f.about(
            "A body with its surface moved outward by amplitude times a texture. The texture is looked up "
            "in space, in the sdf's own coordinates: by the mappings \"spherical\", \"cylindrical\" and "
            "\"planar\", or with x and y for u and v. It must vary continuously.");
        f.field("child", &DisplacementSdf::child, "name of an sdf that was defined before").required();
        f.field("texture", &DisplacementSdf::texture, "how far, as a part of the amplitude");
        f.field("amplitude", &DisplacementSdf::amplitude, "factor on the texture");
        f.field("slope", &DisplacementSdf::slope,
                "the most by which the texture changes along a unit of length")
            .at_least(0)
            .otherwise("twice the most that is found by sampling");
        f.example("fat", {make_string("child", "sphere"), make_float("texture", 0.5f),
                          make_float("amplitude", 0.2f)});
    }

    void finish(const Node& node, BuildContext& context) {
        if (!require_bounded(child, node, context)) return;
        Survey found = survey();
        Vec3d size = child->bounds().size();
        if (found.is_broken)
            return context.messages.add_error(
                node.place, "the texture jumps; only one that varies continuously can displace a surface");
        if (slope && found.slope > static_cast<double>(*slope) * (1 + 1e-3))
            return context.messages.add_error(
                node.place,
                fmt::format("the texture changes by up to {:.4g} along a unit of length; \"slope\" "
                            "is {}, but must be at least that",
                            found.slope, *slope));
        double steepest = slope ? static_cast<double>(*slope) : 2 * found.slope;
        double height = std::abs(static_cast<double>(amplitude));
        stretch_ = 1 + height * steepest;
        reach_ = height * found.largest * (texture.is_constant() ? 1 : 1.05);
        step_ = 1e-4 * max_component(size);
        // Textures see single precision: their results and the points they are asked for are rounded.
        double far = length(max(abs(child->bounds().lo), abs(child->bounds().hi)));
        if (!texture.is_constant()) noise_ = height * (found.largest * 0x1p-21 + steepest * far * 0x1p-22);
    }

    template <class S>
    S at(TVec3<S> p) const {
        S base = child->value(p);
        // The lower of the displaced field and a bound that far away is the lower one whatever the texture
        // is.
        S bound = (base + S(reach_)) * S(0.5 / stretch_);
        if (value_of(base) > 3 * reach_) return bound;
        Vec3d q = values_of(p);
        double moved = height(q);
        if constexpr (std::is_same_v<S, double>) return std::min((base - moved) / stretch_, bound);
        Vec3d slope_here;
        for (int i = 0; i < 3; ++i) {
            Vec3d step;
            step[i] = step_;
            slope_here[i] = (height(q + step) - height(q - step)) / (2 * step_);
        }
        return std::min((base - with_gradient(moved, slope_here, p)) / S(stretch_), bound);
    }
    Box bounds() const override { return child->bounds().grown(reach_); }
    double noise() const override { return (child->noise() + noise_) / stretch_; }

  private:
    struct Survey {
        double largest = 0, slope = 0; ///< of the texture's values
        bool is_broken = false;
    };

    double look_up(Vec3d p) const {
        return static_cast<double>(
            texture.eval({Vec3(p), Vec3{0, 0, 1}, {static_cast<float>(p.x), static_cast<float>(p.y)}}));
    }
    double height(Vec3d p) const {
        return std::clamp(static_cast<double>(amplitude) * look_up(p), -reach_, reach_);
    }
    // The most that the texture changes over a step, by the step.
    double steepest(double step, double& largest) const {
        Box box = child->bounds();
        Vec3d size = box.size();
        Rng rng(1);
        double most = 0;
        for (int i = 0; i < (texture.is_constant() ? 1 : 8192); ++i) {
            Vec3d p = box.lo, gradient;
            for (int k = 0; k < 3; ++k) p[k] += size[k] * static_cast<double>(rng.uniform());
            double here = look_up(p);
            for (int k = 0; k < 3; ++k) {
                Vec3d q = p;
                q[k] += step;
                gradient[k] = (look_up(q) - here) / step;
            }
            largest = std::max(largest, std::abs(here));
            most = std::max(most, length(gradient));
        }
        return most;
    }
    // Where a texture jumps, a step of a sixteenth finds sixteen times the slope.
    Survey survey() const {
        double size = max_component(child->bounds().size());
        Survey found;
        double coarse = steepest(2e-3 * size, found.largest), fine = steepest(1.25e-4 * size, found.largest);
        found.slope = std::max(coarse, fine);
        found.is_broken = fine > 6 * coarse && fine * size > 100;
        return found;
    }

    double stretch_ = 1, reach_ = 0, step_ = 1e-4, noise_ = 0;
};

} // namespace

Kind<Sdf> displacement_sdf() {
    return make_kind<Sdf, DisplacementSdf>("displacement");
}

} // namespace alhazen
