/// A set of rays through a scene's structure, ray by ray or in batches.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "lab/peer.h"
#include "scene/object.h"

namespace alhazen {

/// How a structure is handed its rays.
enum class TraceMode { single, batch };
std::string_view name_of(TraceMode mode);
std::string_view name_of(Query query);

/// Rays in a batch: what a scheduler with so many paths in flight hands over at a time.
inline constexpr std::size_t batch_size = 128;

/// What was found: hits for closest, blocked for any; one a ray.
struct Answers {
    std::vector<Intersection> hits;
    std::vector<std::uint8_t> blocked;

    /// As constructed, for so many rays.
    void reset(Query query, std::size_t rays);
    /// Whether ray i met something.
    bool found(Query query, std::size_t i) const {
        return query == Query::closest ? hits[i].found() : blocked[i] != 0;
    }
};

/// Traces the rays on so many threads, in ranges of whole batches; returns the seconds (see seconds_of).
/// Where root is a mesh, its structure is asked without the scene around it and cutouts count as solid, as
/// for the peer.
double trace(const Object& root, Query query, TraceMode mode, std::span<const Ray> rays, int threads,
             Answers& answers);
double trace(const Peer& peer, Query query, PeerCall call, std::span<const Ray> rays, int threads,
             Answers& answers);

/// How two answers to the same rays compare, as fractions of the rays.
struct Agreement {
    double same = 1; ///< the same primitive, or none both times
    double ties = 0; ///< another primitive at the same distance, to within 1e-5 of it
};
Agreement compare(Query query, const Answers& a, const Answers& b);

} // namespace alhazen
