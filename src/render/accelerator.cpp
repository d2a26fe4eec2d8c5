/// pbrt's two accelerators by name, whose parameters are about pbrt's own trees: they are read and have no
/// effect.
#include "render/accelerator.h"

#define KINDS Accelerator, accelerator, "render/accelerator_list.h"
#include "describe/register_kinds.inl"

namespace alhazen {

namespace {

constexpr const char* unused = "pbrt's; no effect";

struct BvhAccelerator final : Accelerator {
    int maxnodeprims = 4;
    std::string splitmethod = "sah";

    static void describe(Fields<BvhAccelerator>& f) {
        f.about("A hierarchy of boxes, by any builder and walk; the picture does not depend on which.");
        describe_common(f);
        f.field("maxnodeprims", &BvhAccelerator::maxnodeprims, unused);
        f.field("splitmethod", &BvhAccelerator::splitmethod, unused);
        f.example("stackless", {make_string("builder", "lbvh"), make_string("walk", "stackless")});
    }
    void finish(const Node& node, BuildContext& context) { choose(node, context); }
};

struct KdTreeAccelerator final : Accelerator {
    int intersectcost = 5, traversalcost = 1, maxprims = 1, maxdepth = -1;
    float emptybonus = 0.5f;

    KdTreeAccelerator() { builder = "kdtree"; }
    static void describe(Fields<KdTreeAccelerator>& f) {
        f.about("The same, built by halving space.");
        describe_common(f);
        f.field("intersectcost", &KdTreeAccelerator::intersectcost, unused);
        f.field("traversalcost", &KdTreeAccelerator::traversalcost, unused);
        f.field("emptybonus", &KdTreeAccelerator::emptybonus, unused);
        f.field("maxprims", &KdTreeAccelerator::maxprims, unused);
        f.field("maxdepth", &KdTreeAccelerator::maxdepth, unused);
    }
    void finish(const Node& node, BuildContext& context) { choose(node, context); }
};

struct SdfAccelerator final : Accelerator {
    int resolution = usual_distance_field;

    static void describe(Fields<SdfAccelerator>& f) {
        f.about("Approximate: rays from the camera are traced exactly, all others (shadows, bounces, ambient "
                "occlusion) through one distance field of the whole scene. Shadows lose details and contacts "
                "that are smaller than a cell, and reflections show the field's coarse shapes. Nothing is "
                "met within half a cell of where a ray starts. To compare with, and to see light as "
                "game engines compute it; pictures take about as long. Shapes that are no triangles are an "
                "error.");
        f.field("resolution", &SdfAccelerator::resolution, "cells along the longest side of the scene")
            .in(8, 1024);
        describe_common(f);
        f.example("coarse", {make_integer("resolution", 64)});
    }
    void finish(const Node& node, BuildContext& context) {
        choose(node, context);
        choice.distance_field = resolution;
    }
};

} // namespace

void Accelerator::choose(const Node& node, BuildContext& context) {
    std::string error;
    auto parsed = parse_accel(builder + "/" + walk, error);
    if (!parsed) {
        bool is_walk = parse_accel(builder, error).has_value();
        parse_accel(builder + "/" + walk, error);
        context.messages.add_error(node.place_of(is_walk ? "walk" : "builder"), error);
        return;
    }
    choice = *parsed;
    choice.walk_options.stack_entries = stackentries;
}

Kind<Accelerator> bvh_accelerator() {
    return make_kind<Accelerator, BvhAccelerator>("bvh");
}

Kind<Accelerator> sdf_accelerator() {
    return make_kind<Accelerator, SdfAccelerator>("sdf");
}

Kind<Accelerator> kdtree_accelerator() {
    return make_kind<Accelerator, KdTreeAccelerator>("kdtree");
}

} // namespace alhazen
