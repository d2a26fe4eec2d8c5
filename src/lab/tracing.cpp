#include "lab/tracing.h"

#include <algorithm>
#include <cmath>

#include "base/threads.h"
#include "lab/timing.h"

namespace alhazen {

namespace {

/// Rays a thread takes at a time: whole batches.
constexpr std::size_t grain = 16 * batch_size;

// Calls body(begin, end) for ranges that make up all rays; returns the seconds.
template <class Body>
double run(std::size_t rays, int threads, const Body& body) {
    if (threads == 1) return seconds_of(1, [&] { body(std::size_t{0}, rays); });
    double seconds = 0;
    with_threads(threads,
                 [&] { seconds = seconds_of(threads, [&] { parallel_ranges(rays, grain, body); }); });
    return seconds;
}

// Calls body(begin, count) for the batches of a range.
template <class Body>
void for_batches(std::size_t begin, std::size_t end, const Body& body) {
    for (std::size_t i = begin; i < end; i += batch_size) body(i, std::min(batch_size, end - i));
}

void trace_structure(const Structure& structure, Query query, TraceMode mode, std::span<const Ray> rays,
                     std::size_t begin, std::size_t end, Answers& answers) {
    NoTests tests;
    std::span<Intersection> hits(answers.hits);
    std::span<std::uint8_t> blocked(answers.blocked);
    if (mode == TraceMode::batch)
        return for_batches(begin, end, [&](std::size_t i, std::size_t n) {
            if (query == Query::closest)
                structure.closest(rays.subspan(i, n), hits.subspan(i, n), tests);
            else
                structure.any(rays.subspan(i, n), blocked.subspan(i, n), tests);
        });
    if (query == Query::closest)
        for (std::size_t i = begin; i < end; ++i) structure.closest(rays[i], hits[i], tests);
    else
        for (std::size_t i = begin; i < end; ++i) blocked[i] = structure.any(rays[i], tests);
}

void trace_object(const Object& root, Query query, TraceMode mode, std::span<const Ray> rays,
                  std::size_t begin, std::size_t end, Answers& answers) {
    std::span<std::uint8_t> blocked(answers.blocked);
    if (query == Query::any) {
        if (mode == TraceMode::single)
            for (std::size_t i = begin; i < end; ++i) blocked[i] = root.any(rays[i]);
        else
            for_batches(begin, end, [&](std::size_t i, std::size_t n) {
                root.any(rays.subspan(i, n), blocked.subspan(i, n));
            });
        return;
    }
    std::vector<Found> found;
    for_batches(begin, end, [&](std::size_t i, std::size_t n) {
        found.assign(n, Found{});
        if (mode == TraceMode::single)
            for (std::size_t k = 0; k < n; ++k) root.closest(rays[i + k], found[k]);
        else
            root.closest(rays.subspan(i, n), std::span(answers.hits).subspan(i, n), found);
        for (std::size_t k = 0; k < n; ++k) answers.hits[i + k] = found[k].hit;
    });
}

} // namespace

std::string_view name_of(TraceMode mode) {
    return mode == TraceMode::single ? "single" : "batch";
}

std::string_view name_of(Query query) {
    return query == Query::closest ? "closest" : "any";
}

void Answers::reset(Query query, std::size_t rays) {
    hits.assign(query == Query::closest ? rays : 0, Intersection{});
    blocked.assign(query == Query::any ? rays : 0, 0);
}

double trace(const Object& root, Query query, TraceMode mode, std::span<const Ray> rays, int threads,
             Answers& answers) {
    answers.reset(query, rays.size());
    bool is_bare = is_mesh(root);
    return run(rays.size(), threads, [&](std::size_t begin, std::size_t end) {
        if (is_bare)
            trace_structure(root.structure(), query, mode, rays, begin, end, answers);
        else
            trace_object(root, query, mode, rays, begin, end, answers);
    });
}

double trace(const Peer& peer, Query query, PeerCall call, std::span<const Ray> rays, int threads,
             Answers& answers) {
    answers.reset(query, rays.size());
    return run(rays.size(), threads, [&](std::size_t begin, std::size_t end) {
        std::size_t n = end - begin;
        if (query == Query::closest)
            peer.closest(rays.subspan(begin, n), std::span(answers.hits).subspan(begin, n), call);
        else
            peer.any(rays.subspan(begin, n), std::span(answers.blocked).subspan(begin, n), call);
    });
}

Agreement compare(Query query, const Answers& a, const Answers& b) {
    std::size_t count = query == Query::closest ? a.hits.size() : a.blocked.size();
    if (count == 0) return {};
    std::size_t same = 0, ties = 0;
    for (std::size_t i = 0; i < count; ++i) {
        bool found = a.found(query, i);
        if (found != b.found(query, i)) continue;
        bool is_same = query == Query::any || !found || a.hits[i].primitive == b.hits[i].primitive;
        same += is_same;
        ties += !is_same && std::abs(a.hits[i].t - b.hits[i].t) <= 1e-5f * a.hits[i].t;
    }
    auto n = static_cast<double>(count);
    return {static_cast<double>(same) / n, static_cast<double>(ties) / n};
}

} // namespace alhazen
