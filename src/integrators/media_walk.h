/// Steps of paths through participating media: along a ray until something happens, and on to a light.
#pragma once

#include <optional>

#include "integrators/direct_light.h"
#include "integrators/lane_weights.h"
#include "integrators/path_context.h"
#include "media/collisions.h"

namespace alhazen {

/// Where random numbers for the media along a stretch of a path come from: for each, one that places the
/// first collision, and the key of a generator for what follows, since nobody can say how much there will be.
class MediumNumbers {
  public:
    struct Start {
        float u = 0;
        std::uint64_t key = 0;
    };

    /// The sampler's next number for each medium. The stream must outlive this.
    explicit MediumNumbers(SampleStream& samples) : samples_(&samples) {}
    /// The given start for the first medium, and others that it determines.
    explicit MediumNumbers(Start start) : start_(start) {}
    static MediumNumbers from_key(std::uint64_t key) { return MediumNumbers(Start{unit_float(key), key}); }

    Start next() {
        if (samples_) return start_from(*samples_);
        const Start start = start_;
        start_.key = hash_of(start_.key);
        start_.u = unit_float(start_.key);
        return start;
    }
    /// Takes one number.
    static Start start_from(SampleStream& samples) {
        const float u = samples.next1();
        const SampleState& s = samples.state();
        return {u, hash_of(std::bit_cast<std::uint32_t>(u), s.pixel.x, s.pixel.y, s.sample, s.dimension)};
    }

  private:
    SampleStream* samples_ = nullptr;
    Start start_;
};

/// How a ray's way through a medium ended.
struct MediumCrossing {
    enum class End { passed, scattered, absorbed };
    End end = End::passed;
    Spectrum emitted = 0; ///< by the medium on the way, weighed
    Vec3 p, wo;           ///< where it was scattered, and unit vector back along the ray
};

/// A ray's way through a medium, step by step.
class MediumWalk {
  public:
    /// counts_emission: whether what glows is seen. weights: the path's, which the way changes. clear: where
    /// no surface can be, when the ray may meet one before its tmax; nullptr when it cannot. What is
    /// referred to must outlive this.
    MediumWalk(const Medium& medium, const Ray& ray, bool counts_emission, LaneWeights& weights,
               PathContext& path, MediumNumbers& numbers, const ClearCells* clear);

    /// Goes on to the end of the way. False when it first has to be known where the ray meets a surface,
    /// which meet() has to say.
    bool go_on();
    /// The nearest surface is at t; infinity for none.
    void meet(float t) {
        collisions_.meet(t);
        end_ = std::min(end_, t);
    }
    /// How the way ended.
    const MediumCrossing& crossing() const { return crossing_; }

  private:
    /// Whether the way ends there.
    bool collide(const Collision& collision);

    Ray ray_;
    LaneWeights& weights_;
    Collisions collisions_;
    bool emits_, is_homogeneous_;
    float end_; ///< of the ray, as far as it is known
    MediumCrossing crossing_;
};

/// Follows the ray through the medium up to ray.tmax. counts_emission: whether what glows is seen.
MediumCrossing cross_medium(const Medium& medium, const Ray& ray, bool counts_emission, LaneWeights& weights,
                            PathContext& path, MediumNumbers& numbers);

/// Next event estimation at a point of a medium, for paths that go on in a direction of the phase function
/// and find lights so, too (as LightSampling::beside_bsdf); takes three random numbers.
std::optional<DirectLight> propose_light_in_medium(const MediumCrossing& at, const Medium& medium, float time,
                                                   PathContext& path);

/// Weights at the light's end of a shadow ray that begins in the medium: through media and their borders,
/// black where something stands in between. Homogeneous media weaken the light by a known factor, others by
/// ratio tracking. is_sky: see DirectLight; where a homogeneous medium has no end on the way there, scattered
/// rays would never find what light sampling finds at the scene's edge, and both have to be left to chance.
Task<LaneWeights> shadow_weights(Ray ray, const Medium* medium, bool is_sky, LaneWeights weights,
                                 PathContext& path, MediumNumbers numbers);

/// The medium where the ray begins: that on this side of the first border on the way to the camera, or the
/// camera's own. Lights do not know theirs; to paths that find them it follows from the borders, too.
Task<const Medium*> medium_at(Ray ray, Vec3 camera, PathContext& path);

} // namespace alhazen
