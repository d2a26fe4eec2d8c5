/// Integrators: the light that arrives along a camera ray, or at a whole picture.
#pragma once

#include <memory>

#include "describe/kind.h"
#include "integrators/bundle/bundles.h"
#include "integrators/path_context.h"
#include "integrators/picture.h"
#include "integrators/task.h"

namespace alhazen {

struct Integrator {
    static constexpr std::string_view family_name = "integrator";
    virtual ~Integrator() = default;

    /// The radiance arriving against the ray (one sample of it), in path's wavelengths or RGB.
    virtual Task<Spectrum> radiance(Ray ray, PathContext& path) const = 0;

    /// Called once when everything is there, before the film is started and anything is rendered.
    virtual void prepare(const PictureOrder& /*picture*/) {}
    /// True for those that bring light to the film themselves, by Film::add_splat: one path from the lights
    /// for each sample of a pixel, or by a whole picture's own count. They need a camera that receives light.
    virtual bool makes_splats() const { return false; }
    /// True for those that make pixels by Film::set: they need a film that takes splats, too.
    virtual bool sets_pixels() const { return false; }
    /// Names of pictures that they splat beside the one that is wanted: the film's layers from 1 on.
    virtual std::vector<std::string> splat_layers() const { return {}; }
    /// True where pixels are made of radiance() along camera rays, followed one by one through PathContext.
    virtual bool follows_camera_rays() const { return true; }
    /// For scenes in which many camera rays are followed together sooner than one by one: who does it, for
    /// rays of RGB, with the very bits of radiance(). The scene must outlive it. nullptr: nobody.
    virtual std::unique_ptr<RayBundles> bundles(const Scene& /*scene*/) const { return nullptr; }
    /// For integrators that make pictures as a whole: the work on this one. nullptr: the picture is made of
    /// radiance().
    virtual std::unique_ptr<PictureWork> whole_picture(const PictureOrder& /*picture*/) const {
        return nullptr;
    }
    /// Samples a pixel, given what the sampler says and what the user has asked for, if anything.
    virtual int samples_per_pixel(int sampler, std::optional<int> asked) const {
        return asked.value_or(sampler);
    }

    /// True for models that are defined in linear RGB.
    virtual bool works_in_rgb() const { return false; }
    /// False where all that moves is shown as it is when the shutter opens.
    virtual bool sees_motion() const { return true; }
    /// True when participating media are seen; for others they are not there.
    virtual bool sees_media() const { return false; }
    /// True when light spreads beneath surfaces (Material::subsurface); others see their borders only.
    virtual bool sees_subsurface() const { return false; }
    /// True when a picture of one sample a pixel goes through the pixels' centres.
    virtual bool centres_single_samples() const { return false; }
    /// How lights are chosen: one of light_chooser_names().
    virtual std::string light_sampler() const { return "bvh"; }
};

const KindList<Integrator>& integrator_kinds();

} // namespace alhazen
