/// Surfaces of distance fields that are sampled on grids.
#include <fmt/format.h>

#include "sdf/voxel_field.h"
#include "shapes/placement.h"
#include "shapes/projected_uv.h"
#include "shapes/shape.h"
#include "shapes/triangle_points.h"

namespace alhazen {

enum class GridNormals { smooth, analytic };
template <>
struct EnumNames<GridNormals> {
    static constexpr std::array names{"smooth", "analytic"};
};

namespace {

struct SdfGrid final : Shape {
    std::string filename, grid;
    GridNormals normals = GridNormals::smooth;

    static void describe(Fields<SdfGrid>& f) {
        f.about(
            "The surface of a signed distance field that a file holds samples of: negative inside, "
            "interpolated trilinearly. `alhazen sdf` makes such files of meshes and scenes. Its parameters u "
            "and v are two of the coordinates, over the longest side of its bounds.");
        f.field("filename", &SdfGrid::filename,
                "the file, relative to the scene's folder: .vol (Mitsuba 3), or .nvdb (NanoVDB) with a level "
                "set, "
                "where the program was built with it")
            .required();
        f.field("grid", &SdfGrid::grid, "name of the grid in a file with several").otherwise("the first");
        f.field("normals", &SdfGrid::normals,
                "for shading: continuous from cell to cell, or those of the interpolated surface");
        describe_common(f);
        f.example("scan", {make_string("filename", "volumes/scan.vol")});
        f.example("facets",
                  {make_string("filename", "volumes/scan.vol"), make_string("normals", "analytic")});
    }
    void finish(const Node& node, BuildContext& context) {
        const Place& place = node.place_of("filename");
        std::string prefix = fmt::format("grid file \"{}\": ", filename);
        if (!context.grid_reader || !*context.grid_reader) {
            context.messages.add_error(place, prefix + "grid files cannot be read here");
            return;
        }
        try {
            GridData data = (*context.grid_reader)(context.resolve(filename), grid);
            field_ = VoxelField(data);
            BuildContext inner = context;
            inner.world_from_node = Transform(context.world_from_node.matrix() * data.object_from_index);
            inner.reverse_orientation =
                context.reverse_orientation != (data.object_from_index.determinant3() < 0);
            placement_.set(node, inner);
            if (field_.bounds().is_empty())
                context.messages.add_error(
                    place, prefix + (data.is_level_set
                                         ? "no surface: all its values are of one sign"
                                         : "it holds a volume's density, not the distance from a surface"));
        } catch (const std::runtime_error& e) {
            context.messages.add_error(place, prefix + e.what());
        }
    }

    Bounds3 bounds(std::uint32_t) const override {
        return placement_.box_bounds(field_.bounds().lo, field_.bounds().hi);
    }
    bool intersect(const Ray& ray, std::uint32_t, Intersection& hit) const override {
        if (!is_finite(ray.o) || !is_finite(ray.d) || !(ray.tmax > 0)) return false;
        ObjectRay r = placement_.to_object(ray);
        if (!(dot(r.d, r.d) > 0)) return false;
        auto exact = field_.first_crossing(r.o, r.d, static_cast<double>(next_up(ray.tmax)));
        if (!exact) return false;
        auto t = static_cast<float>(*exact);
        if (!(t > 0) || !(t < ray.tmax)) return false;
        hit.t = t;
        hit.u = static_cast<float>(*exact - static_cast<double>(t));
        hit.v = 0;
        return true;
    }
    Hit surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const override {
        ObjectRay r = placement_.to_object(ray);
        double t = static_cast<double>(met.t) + static_cast<double>(met.u);
        Vec3d p = r.at(t), n = normal_at(p, -r.d);
        ProjectedUv local = project_uv(p, n, field_.bounds());
        Hit hit;
        hit.p = Vec3(placement_.point(p));
        hit.p_error = point_error(p) + Vec3((abs(Vec3d(ray.o)) + abs(Vec3d(ray.d)) * t) * 4e-15);
        hit.wo = Vec3(normalize(Vec3d(-ray.d)));
        hit.ng = hit.ns = placement_.normal(n);
        if (normals == GridNormals::smooth) {
            Vec3d g = field_.smooth_gradient(p);
            if (dot(g, n) > 0) hit.ns = face_forward(placement_.normal(g), hit.ng);
        }
        hit.dpdu = Vec3(placement_.vector(local.dpdu));
        hit.dpdv = Vec3(placement_.vector(local.dpdv));
        hit.uv = local.uv;
        hit.t = met.t;
        hit.time = ray.time;
        hit.primitive = primitive;
        return hit;
    }

    // As fine as the grid itself.
    bool tessellate(double /*tolerance*/, const TriangleSink& out) const override {
        for (const auto& [a, b, c] : field_.triangles()) {
            const bool is_outward = dot(cross(b - a, c - a), field_.gradient((a + b + c) * (1.0 / 3))) >= 0;
            out(is_outward ? placement_.triangle(a, b, c) : placement_.triangle(a, c, b));
        }
        return true;
    }

    float area(std::uint32_t) const override { return points().area(); }
    ShapeSample sample(std::uint32_t, Vec2 u) const override {
        auto near = points().at(u);
        if (!near) return {};
        Vec3d p = field_.move_to_surface(*near), n = normal_at(p, {0, 0, 1});
        return {Vec3(placement_.point(p)), point_error(p), placement_.normal(n),
                project_uv(p, n, field_.bounds()).uv, 1 / points().area()};
    }
    std::size_t bytes() const override { return sizeof *this + field_.bytes(); }

  private:
    Vec3d normal_at(Vec3d p, Vec3d otherwise) const {
        Vec3d g = field_.gradient(p);
        double l = length(g);
        return l > 0 ? g * (1 / l) : normalize(otherwise);
    }
    // Twice the rounding: where cells meet, the surface has an edge, and the next cell's is not quite so far
    // off.
    Vec3 point_error(Vec3d p) const { return placement_.point_error(p) * 2.0f; }
    const TrianglePoints& points() const {
        return points_.get([this] {
            return TrianglePoints(field_.triangles(), [this](Vec3d p) { return placement_.point(p); });
        });
    }

    VoxelField field_;
    Placement placement_;
    OnDemand<TrianglePoints> points_;
};

} // namespace

Kind<Shape> sdfgrid_shape() {
    return make_kind<Shape, SdfGrid>("sdfgrid");
}

} // namespace alhazen
