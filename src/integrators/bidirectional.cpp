#include "integrators/bidirectional.h"

#include "integrators/media_walk.h"
#include "integrators/medium_vertex.h"
#include "integrators/shading_normal.h"
#include "materials/material.h"

namespace alhazen {

namespace {

// Random numbers of each vertex: for a light, for the next direction, for roulette; from the light one for a
// light less, but two for the lens.
constexpr std::uint32_t numbers_per_camera_vertex = 3 + 3 + 1;
// And where there are media, for the way to the vertex.
constexpr std::uint32_t numbers_per_way = 1;

/// What a subpath has to do with media.
struct MediaState {
    const Medium* medium = nullptr; ///< that it is in
    LaneWeights lanes;              ///< what they have made of it
    MediumNumbers::Start numbers;   ///< for the way to the next vertex
};

} // namespace

/// Which strategies are asked for.
struct Bidirectional::Wanted {
    std::optional<Strategy> only;
    int maxdepth;

    bool operator()(int light, int camera) const {
        const Strategy s{light, camera};
        return only ? s == *only : s.bounces() <= maxdepth;
    }
    int light_vertices() const { return only ? only->light : maxdepth + 1; }
    int camera_vertices() const { return only ? only->camera : maxdepth + 2; }
};

/// A subpath on its way from one vertex to the next.
struct Bidirectional::Walk {
    Ray ray;
    LightReceiver from;      ///< the vertex that was left
    Spectrum start = 1;      ///< what the subpath carried when it began
    Spectrum throughput = 1; ///< the fraction that is left of it
    float eta_scale = 1;     ///< radiance squeezed by refraction, which roulette must not count as loss
    Alternatives others;     ///< per steradian at the vertex that was left
    Wavelengths lambda;
    bool rough_before = false;
    MediaState* media = nullptr; ///< where there are any

    bool is_in_medium() const { return media && media->medium; }
    /// What the subpath makes of light at its end.
    Spectrum brings(Spectrum L) const {
        const Spectrum all = start * throughput * L;
        return media ? media->lanes.alone(all) : all;
    }
    Bsdf* bsdf_at(const Hit& hit, Arena& arena) {
        if (!is_on_surface(hit)) return arena.make<PhaseBsdf>(media->medium->phase());
        Bsdf* bsdf = hit.material->at(hit, lambda, arena);
        if (media) media->lanes.follow(lambda);
        return bsdf;
    }
    /// Straight on, through a border of media.
    void go_on(const Hit& border) {
        if (media) media->medium = medium_beyond(border, ray.d, media->medium);
        ray = border.spawn(ray.d);
    }
    /// Through the medium to what was hit, if anything, or to a place in the medium, which then is the hit.
    /// False when the walk is absorbed. emitted: nullptr, or gets what the medium adds on the way, weighed.
    bool cross_medium(std::optional<Hit>& hit, Spectrum* emitted, PathContext& path) {
        Ray part = ray;
        part.tmax = hit ? hit->t : infinity;
        MediumNumbers numbers(media->numbers);
        const MediumCrossing crossing =
            alhazen::cross_medium(*media->medium, part, emitted != nullptr, media->lanes, path, numbers);
        media->numbers = numbers.next();
        if (emitted) *emitted = crossing.emitted;
        if (crossing.end == MediumCrossing::End::scattered) hit = place_in_medium(crossing, ray.time);
        return crossing.end != MediumCrossing::End::absorbed;
    }
};

/// A point of a surface, or in a medium, on a subpath.
struct Bidirectional::Vertex {
    Hit hit;
    Frame frame;
    Vec3 wo; ///< towards the vertex before it, in the frame
    Bsdf* bsdf = nullptr;
    Spectrum carried; ///< by the subpath until here
    Alternatives others;
    int number = 0; ///< of vertices until here, itself counted in
    bool one_wavelength = false;
    float without_area = 0;            ///< 1 in a medium
    const Vertex* previous = nullptr;  ///< of those that can be joined
    const MediaState* media = nullptr; ///< of the subpath when it arrived, where there are any

    Vertex(const Walk& walk, const Hit& at, Bsdf* bsdf_, const Alternatives& others_, int number_)
        : hit(at), frame(is_on_surface(at) ? at.shading_frame() : Frame()), wo(frame.to_local(at.wo)),
          bsdf(bsdf_), carried(walk.start * walk.throughput), others(others_), number(number_),
          one_wavelength(walk.lambda.secondary_terminated()), without_area(is_on_surface(at) ? 0.0f : 1.0f) {}

    bool can_be_joined() const { return has(bsdf->lobes(), Lobes::diffuse | Lobes::glossy); }
    /// For light that goes on along w from a subpath that came from the camera.
    Scatter from_camera(Vec3 w) const { return bsdf->eval(wo, frame.to_local(w)); }
    Scatter from_light(Vec3 w) const {
        Scatter s = bsdf->eval(wo, frame.to_local(w), TransportMode::importance);
        if (is_on_surface(hit)) s.f *= shading_correction(hit, hit.wo, w);
        return s;
    }
    /// As cosine_at() has it, whose normal is zero in a medium.
    float cosine(Vec3 w) const { return abs_dot(hit.ng, w) + without_area; }
};

/// A path that is found if nothing is in the way.
struct Bidirectional::Join {
    FoundPath found;
    Ray shadow_ray;
};

Bidirectional::Bidirectional(const PictureOrder& picture, const Options& options)
    : scene_(picture.scene), camera_(picture.camera), film_(picture.film), options_(options),
      has_media_(picture.scene.has_media()), lights_(lights_by_power(picture.scene.lights())),
      light_paths_(rendered_fraction(picture.film)) {}

// The camera's ray goes first, as paths count them; then the light's walk, whose vertices the camera's meets.
Task<bool> Bidirectional::find_paths(Ray camera_ray, PathContext& path, PathTaker& taker,
                                     std::optional<Strategy> only) const {
    const Wanted wanted{only, options_.maxdepth};
    Walk walk;
    walk.ray = camera_ray;
    walk.from.p = camera_ray.o;
    walk.lambda = path.lambda;
    if (has_media_) {
        const LaneWeights lanes(path.lambda, path.samples.next1());
        walk.media = path.arena.make<MediaState>(scene_.medium_at_camera(), lanes,
                                                 MediumNumbers::start_from(path.samples));
    }
    std::optional<Hit> first;
    if (wanted.camera_vertices() > 1) first = co_await path.closest(walk.ray);
    const Vertex* lit = co_await walk_from_light(walk, path, taker, wanted);
    if (wanted.camera_vertices() > 1) co_await walk_from_camera(walk, first, path, lit, taker, wanted);
    co_return true;
}

Vec2 Bidirectional::next_on_lens(SampleStream& samples) const {
    if (camera_.has_lens()) return samples.next2();
    samples.skip(2);
    return {};
}

/// The last of the vertices that can be joined.
Task<const Bidirectional::Vertex*> Bidirectional::walk_from_light(const Walk& camera, PathContext& path,
                                                                  PathTaker& taker, Wanted wanted) const {
    const Vertex* lit = nullptr;
    if (wanted.light_vertices() < 2) co_return lit;
    SampleStream samples = path.samples;
    samples.skip((numbers_per_camera_vertex + (has_media_ ? numbers_per_way : 0)) *
                 static_cast<std::uint32_t>(options_.maxdepth + 1));
    const auto start = start_at_light(*lights_, samples, path.lambda, camera.ray.time);
    if (!start) co_return lit;
    Walk walk;
    walk.ray = start->leaving.ray;
    walk.from.p = start->leaving.p;
    walk.start = start->flux();
    walk.lambda = path.lambda;
    if (has_media_) {
        const Medium* medium = co_await medium_at(walk.ray, camera.ray.o, path);
        walk.media =
            path.arena.make<MediaState>(medium, camera.media->lanes, MediumNumbers::start_from(samples));
    }
    for (int number = 2;;) {
        std::optional<Hit> hit = co_await path.closest(walk.ray);
        if (walk.is_in_medium() && !walk.cross_medium(hit, nullptr, path)) break;
        if (!hit) break;
        Bsdf* bsdf = walk.bsdf_at(*hit, path.arena);
        if (!bsdf) {
            walk.go_on(*hit);
            continue;
        }
        const float distance_squared = length_squared(hit->p - walk.from.p);
        if (distance_squared == 0 || cosine_at(*hit, walk.ray.d) == 0) break;
        if (number == 2) walk.start *= start->growth(distance_squared);
        if (options_.regularize && walk.rough_before) bsdf->regularize();
        Vertex* vertex = path.arena.make<Vertex>(
            walk, *hit, bsdf, number == 2 ? first_from_light(*start, *hit) : arrive(walk, *hit), number);
        if (walk.media) vertex->media = path.arena.make<MediaState>(*walk.media);
        const Vec2 lens = next_on_lens(samples);
        if (vertex->can_be_joined()) {
            vertex->previous = lit;
            lit = vertex;
            if (wanted(number, 1))
                if (auto join = join_camera(*vertex, lens)) {
                    bool visible;
                    if (has_media_)
                        visible = co_await cross_media(*join, *vertex, nullptr, path);
                    else
                        visible = co_await path.visible(join->shadow_ray);
                    if (visible) taker.take(join->found);
                }
        }
        if (number++ == wanted.light_vertices()) break;
        if (!scatter(walk, *vertex, samples, TransportMode::importance)) break;
    }
    co_return lit;
}

Task<bool> Bidirectional::walk_from_camera(Walk walk, std::optional<Hit> hit, PathContext& path,
                                           const Vertex* lit, PathTaker& taker, Wanted wanted) const {
    for (int number = 2;; hit = co_await path.closest(walk.ray)) {
        if (walk.is_in_medium()) {
            // Matter that glows counts as if it had scattered light of its own.
            Spectrum emitted = 0;
            const bool goes_on = walk.cross_medium(hit, wanted(0, number + 1) ? &emitted : nullptr, path);
            if (!emitted.is_black()) take_glow(walk, emitted, number, taker);
            if (!goes_on) co_return true;
        }
        if (!hit) {
            if (wanted(0, number)) take_escaped(walk, number, path, taker);
            co_return true;
        }
        const float distance_squared = length_squared(hit->p - walk.from.p);
        if (distance_squared == 0 || cosine_at(*hit, walk.ray.d) == 0) co_return true;
        const Alternatives others = number == 2 ? first_from_camera(walk, *hit) : arrive(walk, *hit);
        if (hit->area_light && wanted(0, number)) take_emitted(walk, *hit, others, number, taker);
        Bsdf* bsdf = walk.bsdf_at(*hit, path.arena);
        if (!bsdf) {
            walk.go_on(*hit);
            continue;
        }
        if (number == wanted.camera_vertices() && !wanted.only) co_return true;
        if (options_.regularize && walk.rough_before) bsdf->regularize();
        Vertex vertex(walk, *hit, bsdf, others, number);
        vertex.media = walk.media;
        const bool can_be_joined = vertex.can_be_joined();
        std::optional<Join> lamp;
        if (can_be_joined && wanted(1, number))
            lamp = join_light(vertex, path);
        else
            path.samples.skip(3);
        if (lamp) {
            bool visible;
            if (has_media_)
                visible = co_await cross_media(*lamp, vertex, nullptr, path);
            else
                visible = co_await path.visible(lamp->shadow_ray);
            if (visible) taker.take(lamp->found);
        }
        for (const Vertex* other = can_be_joined ? lit : nullptr; other; other = other->previous) {
            if (!wanted(other->number, number)) continue;
            if (auto found = join(vertex, *other)) {
                bool visible;
                if (has_media_)
                    visible = co_await cross_media(*found, vertex, other, path);
                else
                    visible = co_await path.visible(found->shadow_ray);
                if (visible) taker.take(found->found);
            }
        }
        if (number++ == wanted.camera_vertices()) co_return true;
        if (!scatter(walk, vertex, path.samples, TransportMode::radiance)) co_return true;
    }
}

/// Through all media between the ends of the shadow ray, the first of which is a vertex; to: the other end,
/// where it is one. False where nothing arrives.
Task<bool> Bidirectional::cross_media(Join& join, const Vertex& from, const Vertex* to,
                                      PathContext& path) const {
    const MediaState& media = *from.media;
    const LaneWeights joined = to ? media.lanes.joined(to->media->lanes) : media.lanes;
    const std::uint64_t key = hash_of(media.numbers.key, to ? to->number : 0);
    const LaneWeights weights =
        co_await shadow_weights(join.shadow_ray, medium_beyond(from.hit, join.shadow_ray.d, media.medium),
                                false, joined, path, MediumNumbers::from_key(key));
    join.found.L = weights.through_shadow(join.found.L);
    co_return !join.found.L.is_black();
}

Alternatives Bidirectional::arrive(const Walk& walk, const Hit& hit) const {
    return walk.others.at_distance(static_cast<double>(length_squared(hit.p - walk.from.p)),
                                   static_cast<double>(cosine_at(hit, walk.ray.d)));
}

// The vertex could be joined with the lens, too; there are that many paths from lights for one from the
// camera.
Alternatives Bidirectional::first_from_camera(const Walk& walk, const Hit& hit) const {
    const float density =
        camera_.ray_density(walk.ray, length(hit.p - walk.from.p)) * cosine_at(hit, walk.ray.d);
    return {density > 0 ? light_paths_ / static_cast<double>(density) : 0, 0};
}

// The light's own vertex, the one before, could be chosen directly for this one, or be met by chance.
// Densities of points on a light are per area, of far lights' directions per steradian, which is all the
// difference.
Alternatives Bidirectional::first_from_light(const LightStart& start, const Hit& hit) const {
    const Light& light = *start.light;
    const LeavingLight& leaving = start.leaving;
    const Vec3 w = leaving.ray.d;
    const bool is_far = light.is_far();
    const auto d2 = static_cast<double>(length_squared(hit.p - leaving.p));
    const auto position = static_cast<double>(leaving.pdf_position),
               direction = static_cast<double>(leaving.pdf_direction);
    const double end = static_cast<double>(start.probability) * (is_far ? direction : position);
    const double onward = (is_far ? position : direction / d2) * static_cast<double>(cosine_at(hit, w));
    const double back = is_far ? 1 : static_cast<double>(leaving.cosine) / d2;

    const LightReceiver at{hit.p, hit.ns};
    double direct = static_cast<double>(scene_.light_probability(at, &light));
    if (light.is_delta()) return {direct / (end * onward), 0};
    if (is_far)
        direct *= static_cast<double>(light.pdf_escaped(at, -w));
    else
        direct *= static_cast<double>(light.pdf_hit(at, start.place(), -w)) * back;
    return {direct / (end * onward), back / (end * onward)};
}

bool Bidirectional::scatter(Walk& walk, const Vertex& vertex, SampleStream& samples,
                            TransportMode mode) const {
    const float u = samples.next1();
    const Vec2 u2 = samples.next2();
    const auto next = vertex.bsdf->sample(vertex.wo, u, u2, mode);
    if (!next || !(next->pdf > 0)) return false;
    const Vec3 w = vertex.frame.to_world(next->wi);
    walk.throughput *= next->f / next->pdf;
    if (mode == TransportMode::radiance) {
        if (has(next->lobes, Lobes::transmission)) walk.eta_scale *= sqr(next->eta);
    } else if (is_on_surface(vertex.hit)) {
        walk.throughput *= shading_correction(vertex.hit, vertex.hit.wo, w);
    }

    const bool is_specular = has(next->lobes, Lobes::specular);
    walk.others = vertex.others.beyond(static_cast<double>(vertex.cosine(w)), static_cast<double>(next->pdf),
                                       static_cast<double>(next->pdf_reverse), is_specular);
    walk.from = {vertex.hit.p, vertex.hit.ns};
    walk.ray = vertex.hit.spawn(w);
    walk.rough_before |= !is_specular;
    Spectrum left = walk.throughput;
    if (MediaState* media = walk.media) {
        left = media->lanes.alone(left);
        media->medium = medium_beyond(vertex.hit, w, media->medium);
        media->numbers = MediumNumbers::start_from(samples);
    }

    // A vertex is worth more than to a path of one end, since all of the other end's are joined with it. In
    // Veach's room the factor 2 was measured to be best, and no roulette to cost half as much again for the
    // same noise.
    const float survival = 2 * (left * walk.eta_scale).max();
    if (options_.roulette && survival < 1 && vertex.number > 2) {
        if (samples.next1() >= survival) return false;
        walk.throughput /= survival;
    } else {
        samples.skip(1);
    }
    return !walk.throughput.is_black();
}

// The light's vertex by chance, against choosing it and against starting there.
double Bidirectional::emission_weight(const Walk& walk, const Light& light, double direct, LeavingPdf leaving,
                                      const Alternatives& others) const {
    direct *= static_cast<double>(scene_.light_probability(walk.from, &light));
    const double started = static_cast<double>(lights_->probability(walk.from, &light)) *
                           static_cast<double>(leaving.position) * static_cast<double>(leaving.direction);
    return 1 / (1 + direct * others.last + started * others.earlier);
}

void Bidirectional::take_emitted(const Walk& walk, const Hit& hit, const Alternatives& others, int number,
                                 PathTaker& taker) const {
    FoundPath found;
    found.strategy = {0, number};
    found.L = walk.brings(hit.area_light->emitted(hit, walk.lambda));
    if (found.L.is_black()) return;
    found.one_wavelength = walk.lambda.secondary_terminated();
    if (number > 2) {
        const double per_area = static_cast<double>(abs_dot(hit.ng, walk.ray.d)) /
                                static_cast<double>(length_squared(hit.p - walk.from.p));
        const double direct =
            static_cast<double>(hit.area_light->pdf_hit(walk.from, hit, walk.ray.d)) * per_area;
        found.weight = emission_weight(walk, *hit.area_light, direct,
                                       hit.area_light->pdf_leaving(hit.ng, hit.wo), others);
    }
    taker.take(found);
}

/// No other strategy finds it.
void Bidirectional::take_glow(const Walk& walk, Spectrum emitted, int number, PathTaker& taker) const {
    FoundPath found;
    found.strategy = {0, number + 1};
    found.L = walk.start * walk.throughput * emitted;
    found.one_wavelength = walk.lambda.secondary_terminated();
    taker.take(found);
}

void Bidirectional::take_escaped(const Walk& walk, int number, const PathContext& path,
                                 PathTaker& taker) const {
    for (const Light* light : path.scene.infinite_lights()) {
        FoundPath found;
        found.strategy = {0, number};
        found.L = walk.brings(light->escaped(walk.from.p, walk.ray.d, walk.lambda));
        if (found.L.is_black()) continue;
        found.one_wavelength = walk.lambda.secondary_terminated();
        // Directions are per steradian already.
        if (number > 2)
            found.weight =
                emission_weight(walk, *light, static_cast<double>(light->pdf_escaped(walk.from, walk.ray.d)),
                                light->pdf_leaving({}, -walk.ray.d), walk.others);
        taker.take(found);
    }
}

std::optional<Bidirectional::Join> Bidirectional::join_light(const Vertex& vertex, PathContext& path) const {
    const LightReceiver at{vertex.hit.p, vertex.hit.ns};
    const std::optional<ChosenLight> chosen = scene_.choose_light(at, path.samples.next1());
    if (!chosen) {
        path.samples.skip(2);
        return std::nullopt;
    }
    const Light& light = *chosen->light;
    const auto sample = light.sample(at, path.pair_for(light), path.lambda);
    if (!sample || !(sample->pdf > 0) || sample->L.is_black()) return std::nullopt;
    const Scatter scatter = vertex.from_camera(sample->wi);
    if (scatter.f.is_black()) return std::nullopt;

    const double direct = static_cast<double>(chosen->probability) * static_cast<double>(sample->pdf);
    const LeavingPdf leaving = light.pdf_leaving(sample->ng, -sample->wi);
    // Of the light's vertex and this one by a path from the light, over choosing the light's alone.
    double started = static_cast<double>(lights_->probability(at, &light)) *
                     static_cast<double>(leaving.position) * static_cast<double>(leaving.direction) *
                     static_cast<double>(vertex.cosine(sample->wi)) / direct;
    if (!light.is_far())
        started /= light.is_delta() ? static_cast<double>(length_squared(sample->p - at.p))
                                    : static_cast<double>(abs_dot(sample->ng, sample->wi));
    const double met = light.is_delta() ? 0 : static_cast<double>(scatter.pdf) / direct;

    Join join;
    join.found.strategy = {1, vertex.number};
    join.found.L = vertex.carried * scatter.f * sample->L / static_cast<float>(direct);
    join.found.weight =
        1 / (1 + met + vertex.others.relative(started, static_cast<double>(scatter.pdf_reverse)));
    join.found.one_wavelength = vertex.one_wavelength;
    join.shadow_ray = vertex.hit.spawn_to(sample->p, sample->p_error, sample->ng);
    return join;
}

std::optional<Bidirectional::Join> Bidirectional::join_camera(const Vertex& vertex, Vec2 lens) const {
    const auto view = camera_.sample_towards(vertex.hit.p, lens, vertex.hit.time);
    if (!view || !film_.splat_reaches(view->film)) return std::nullopt;
    const Scatter scatter = vertex.from_light(-view->d);
    if (scatter.f.is_black()) return std::nullopt;
    const double seen =
        static_cast<double>(view->density) * static_cast<double>(vertex.cosine(view->d)) / light_paths_;
    Join join;
    join.found.strategy = {vertex.number, 1};
    join.found.L = vertex.carried * scatter.f * view->density;
    join.found.weight = 1 / (1 + vertex.others.relative(seen, static_cast<double>(scatter.pdf_reverse)));
    join.found.one_wavelength = vertex.one_wavelength;
    join.found.film = view->film;
    join.shadow_ray = vertex.hit.spawn_to(view->p, Vec3(), Vec3());
    return join;
}

std::optional<Bidirectional::Join> Bidirectional::join(const Vertex& seen, const Vertex& lit) const {
    const Vec3 between = lit.hit.p - seen.hit.p;
    const float d2 = length_squared(between);
    if (!(d2 > 0)) return std::nullopt;
    const Vec3 w = between / std::sqrt(d2); // from the camera's side
    const Scatter at_seen = seen.from_camera(w);
    if (at_seen.f.is_black()) return std::nullopt;
    const Scatter at_lit = lit.from_light(-w);
    if (at_lit.f.is_black()) return std::nullopt;

    const double found_seen = static_cast<double>(at_lit.pdf) * static_cast<double>(seen.cosine(w) / d2);
    const double found_lit = static_cast<double>(at_seen.pdf) * static_cast<double>(lit.cosine(w) / d2);
    Join join;
    join.found.strategy = {lit.number, seen.number};
    join.found.L = seen.carried * at_seen.f * at_lit.f * lit.carried / d2;
    join.found.weight = 1 / (1 + seen.others.relative(found_seen, static_cast<double>(at_seen.pdf_reverse)) +
                             lit.others.relative(found_lit, static_cast<double>(at_lit.pdf_reverse)));
    join.found.one_wavelength = seen.one_wavelength || lit.one_wavelength;
    join.shadow_ray = seen.hit.spawn_to(lit.hit.p, lit.hit.p_error, lit.hit.ng);
    return join;
}

} // namespace alhazen
