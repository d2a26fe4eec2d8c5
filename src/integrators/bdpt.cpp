/// Bidirectional path tracing (Lafortune and Willems 1993; Veach 1997, chapter 10; Pharr et al. 2023, section
/// 16.3): see bidirectional.h. Each sample of a pixel follows a path from the camera and one from a light,
/// and adds all ways of joining them.
#include <algorithm>

#include <fmt/format.h>

#include "integrators/bidirectional.h"
#include "integrators/integrator.h"

namespace alhazen {

namespace {

/// The deepest paths whose strategies are shown one by one, as in pbrt-v4: there are 26 up to here.
constexpr int shown_depth = 5;

std::vector<Strategy> strategies(int maxdepth) {
    std::vector<Strategy> all;
    for (int bounces = 0; bounces <= maxdepth; ++bounces)
        for (int light = 0; light <= bounces + 1; ++light)
            if (const Strategy s{light, bounces + 2 - light}; !(s == Strategy{1, 1})) all.push_back(s);
    return all;
}

struct Bdpt final : Integrator {
    int maxdepth = 5;
    bool visualizestrategies = false;
    bool visualizeweights = false;
    bool regularize = false;

    static void describe(Fields<Bdpt>& f) {
        f.about("Bidirectional path tracer: walks from the camera and from the lights, joined in all ways, "
                "on surfaces and in participating media. For light that is hard to find from the camera: "
                "lamps in shades, caustics.");
        f.field("maxdepth", &Bdpt::maxdepth, "bounces and scatterings of a path at most; 0 shows lights only")
            .in(0, 10000);
        f.field("visualizestrategies", &Bdpt::visualizestrategies,
                "also write what each strategy finds, not weighed, as bdpt_d(bounces)_s(vertices from the "
                "light)_t(vertices from the camera).exr beside the picture; limits maxdepth to 5");
        f.field("visualizeweights", &Bdpt::visualizeweights,
                "the same, but weighed: what each strategy adds to the picture");
        f.field("regularize", &Bdpt::regularize,
                "widen narrow lobes after the first rough bounce: less noise, a little blur");
    }
    void finish(const Node& node, BuildContext& context) {
        if (!(visualizestrategies || visualizeweights) || maxdepth <= shown_depth) return;
        context.messages.add_warning(
            node.place, "integrator \"bdpt\" shows its strategies, which limits \"maxdepth\" to " +
                            std::to_string(shown_depth));
        maxdepth = shown_depth;
    }

    bool sees_media() const override { return true; }
    bool makes_splats() const override { return true; }
    std::vector<std::string> splat_layers() const override {
        std::vector<std::string> names;
        if (visualizestrategies || visualizeweights)
            for (const Strategy& s : strategies(maxdepth))
                names.push_back(fmt::format("bdpt_d{:02}_s{:02}_t{:02}", s.bounces(), s.light, s.camera));
        return names;
    }
    void prepare(const PictureOrder& picture) override {
        film_ = &picture.film;
        rendered_fraction_ = static_cast<float>(rendered_fraction(picture.film));
        if (visualizestrategies || visualizeweights) shown_ = strategies(maxdepth);
        paths_.emplace(picture, Bidirectional::Options{maxdepth, regularize});
    }

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        const Vec2i pixel = path.samples.state().pixel;
        Sample sample(*this, path.lambda, Vec2(pixel) + Vec2(0.5f, 0.5f));
        co_await paths_->find_paths(ray, path, sample);
        co_return sample.sum;
    }

  private:
    /// What one sample finds: light for its own pixel, and splats.
    struct Sample final : PathTaker {
        const Bdpt& bdpt;
        Wavelengths lambda;
        Vec2 center; ///< of the pixel
        Spectrum sum = 0;

        Sample(const Bdpt& bdpt_, const Wavelengths& lambda_, Vec2 center_)
            : bdpt(bdpt_), lambda(lambda_), center(center_) {}
        void take(const FoundPath& found) override {
            const Spectrum L = found.value();
            // What is no number shall be seen in the sample, which is then reported.
            if (!found.film || !L.is_finite())
                sum += L;
            else
                bdpt.film_->add_splat(*found.film, L, lambda);
            if (!bdpt.shown_.empty() && L.is_finite()) show(found);
        }
        void show(FoundPath found) const {
            if (!bdpt.visualizeweights) found.weight = 1;
            const auto which = std::find(bdpt.shown_.begin(), bdpt.shown_.end(), found.strategy);
            const auto layer = static_cast<std::size_t>(which - bdpt.shown_.begin()) + 1;
            // Splats count as if all of the film's pixels had samples.
            const float scale = found.film ? 1 : bdpt.rendered_fraction_;
            bdpt.film_->add_splat(found.film.value_or(center), found.value() * scale, lambda, layer);
        }
    };

    Film* film_ = nullptr;
    float rendered_fraction_ = 1;
    std::vector<Strategy> shown_;
    std::optional<Bidirectional> paths_;
};

} // namespace

Kind<Integrator> bdpt_integrator() {
    return make_kind<Integrator, Bdpt>("bdpt");
}

} // namespace alhazen
