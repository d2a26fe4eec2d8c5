/// The smooth surface that a coarse mesh of triangles controls, as triangles with their corners on it.
#include <fmt/format.h>

#include "shapes/loop_subdivision.h"
#include "shapes/triangle_mesh.h"

namespace alhazen {

namespace {

enum class SubdivisionScheme { loop };

} // namespace

template <>
struct EnumNames<SubdivisionScheme> {
    static constexpr std::array names{"loop"};
};

namespace {

struct SubdividedTriangles final : TriangleMesh {
    int levels = 3;
    SubdivisionScheme scheme = SubdivisionScheme::loop;

    static void describe(Fields<SubdividedTriangles>& f) {
        f.about("A smooth surface: triangles are divided into four again and again by Loop's rules, then put "
                "onto the "
                "limit of doing so for ever. Normals point to the side from which the corners go round "
                "clockwise, as in "
                "pbrt-v4.");
        f.field("P", &SubdividedTriangles::P, "vertex positions of the control mesh").required();
        f.field("indices", &SubdividedTriangles::indices,
                "three vertex numbers for each triangle, counted from 0; at each edge one or two triangles "
                "meet, and "
                "all go round the same way")
            .otherwise("0 1 2 for three vertices");
        f.field("levels", &SubdividedTriangles::levels, "how often triangles are divided").in(0, 12);
        f.field("scheme", &SubdividedTriangles::scheme, "by which rules");
        describe_common(f);
        const std::vector<Vec3> octahedron{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                           {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
        const std::vector<int> sides{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
        f.example("pebble", {make_array("P", ValueType::point3, octahedron),
                             make_array("indices", ValueType::integer, sides), make_integer("levels", 2)});
        f.example("saddle",
                  {make_array<Vec3>("P", ValueType::point3,
                                    {{0, 0, 0}, {1, 0, 0.5f}, {0, 1, -0.5f}, {-1, 0, 0.5f}, {0, -1, -0.5f}}),
                   make_array<int>("indices", ValueType::integer, {0, 1, 2, 0, 2, 3, 0, 3, 4}),
                   make_integer("levels", 1)});
    }

    void finish(const Node& node, BuildContext& context) {
        constexpr std::size_t most_triangles = std::size_t{1} << 27;
        const MeshChecks checks{context.messages, node.place, ""};
        const std::size_t errors = context.messages.error_count();
        if (indices.empty() && P.size() == 3) indices = {0, 1, 2};
        checks.indices(indices, 3, "triangle", P.size());
        checks.finite("P", P);
        if (context.messages.error_count() != errors) return;
        if ((indices.size() / 3) > (most_triangles >> (2 * levels)))
            return checks.error(
                fmt::format("{} triangles divided {} times are more than {}; take fewer \"levels\"",
                            indices.size() / 3, levels, most_triangles));
        LoopSurface surface(std::move(P), indices);
        if (!surface.problem().empty())
            return checks.error("the control mesh cannot be subdivided: " + surface.problem());
        for (int i = 0; i < levels; ++i) surface.refine();
        surface.move_to_limit();
        N = surface.normals();
        indices = surface.indices();
        P = surface.positions();
        prepare(node.place, "", context);
    }
};

} // namespace

Kind<Shape> loopsubdiv_shape() {
    return make_kind<Shape, SubdividedTriangles>("loopsubdiv");
}

} // namespace alhazen
