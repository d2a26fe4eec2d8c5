/// Builders and walks measured on a scene: how fast, how large, how good the tree.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "lab/ray_sets.h"
#include "lab/tracing.h"

namespace alhazen {

struct LabOptions {
    RaySetOptions rays;
    int repeat = 5;                  ///< times each thing is timed
    int threads = 1;                 ///< for building and tracing; 0: all
    std::size_t heat_map_pixels = 0; ///< of the pictures of visits, about; 0: none are made
};

/// A structure, whatever rays it is asked with.
struct BuildRecord {
    AccelChoice choice;
    double build_s = 0;            ///< median: from the scene's shapes to finished structures, of all objects
    double build_spread = 0;       ///< (slowest - fastest) / median
    double bytes_per_triangle = 0; ///< of all objects; per primitive in scenes without triangles
    std::size_t nodes = 0;         ///< of the layout, of all objects
    int depth = 0;                 ///< edges from the root to the deepest leaf, of the scene's own structure
    /// Of the scene's own tree, each node and each primitive costing 1 (see TreeStats).
    double sah_cost = 0;
    double end_point_overlap = 0; ///< the same sums over what does not belong to the nodes
};

/// Walking it with one set of rays.
struct WalkRecord {
    std::size_t build = 0; ///< index of the BuildRecord
    RayKind rays = RayKind::primary;
    Query query = Query::closest;
    TraceMode mode = TraceMode::single;
    double mrays_per_s = 0; ///< median
    double spread = 0;      ///< (largest - smallest) / median of the times
    double nodes_per_ray = 0, leaves_per_ray = 0, restarts_per_ray = 0;
    std::uint32_t max_stack = 0;
    /// With the peer, else empty: median of the ratios of its time to ours, measured in turn; its speed; and
    /// how its answers compare.
    std::optional<double> peer_ratio, peer_mrays_per_s;
    std::optional<Agreement> agreement;
    std::string opponent; ///< the peer's fastest way: "Embree 3.13.5 (AVX2), packets of 16"
};

/// All that was measured in a scene.
struct LabReport {
    std::string scene;
    std::size_t triangles = 0, primitives = 0, instances = 0;
    int threads = 1, repeat = 1;
    Vec2i primary_size;    ///< pixels of the primary rays
    std::string peer;      ///< "Embree 3.13.5"; "" when not compared
    std::string why_alone; ///< when not compared: why
    std::vector<BuildRecord> builds;
    std::vector<WalkRecord> walks;
    Image view;                ///< what the camera sees, lit from where it stands; made when visits are
    std::vector<Image> visits; ///< one a build, when asked for: nodes visited for each pixel's ray
};

struct LabProgress {
    std::size_t done = 0, total = 0; ///< measurements
    std::string what;                ///< in hand: "lbvh/stackless, diffuse"
};

/// Measures every choice. The scene's structures are rebuilt over and over; the last one stays.
LabReport measure(World& world, std::string scene, const std::vector<AccelChoice>& choices,
                  const LabOptions& options, const std::function<void(const LabProgress&)>& progress = {});

/// The scene lit from the camera, without its materials: for orientation.
Image headlight_view(const World& world, Vec2i size);
/// Nodes visited by the ray through each pixel of a picture of that size; one channel.
Image count_visits(const World& world, Vec2i size);

} // namespace alhazen
