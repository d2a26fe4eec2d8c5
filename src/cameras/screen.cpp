#include "cameras/screen.h"

namespace alhazen {

void check_shutter(Camera& camera, const Node& node, BuildContext& context) {
    if (camera.shutterclose >= camera.shutteropen) return;
    context.messages.add_warning(node.place_of("shutterclose"),
                                 "the shutter closes before it opens; the two times are exchanged");
    std::swap(camera.shutteropen, camera.shutterclose);
}

bool FlatCamera::finish_flat(const Node& node, BuildContext& context) {
    check_shutter(*this, node, context);
    world_from_camera_ = context.world_from_node;
    eye_ = Vec3(world_from_camera_.point(Vec3d()));
    const Vec2d size(context.film_resolution);
    resolution_ = size;
    const double aspect = frameaspectratio ? static_cast<double>(*frameaspectratio) : size.x / size.y;
    Vec2d lo = aspect > 1 ? Vec2d(-aspect, -1) : Vec2d(-1, -1 / aspect);
    Vec2d hi = -lo;
    if (!screenwindow.empty()) {
        const Place& place = node.place_of("screenwindow");
        if (screenwindow.size() != 4) {
            context.messages.add_error(place, "parameter \"screenwindow\" has " +
                                                  std::to_string(screenwindow.size()) +
                                                  " values, but must have 4: x from, x to, y from, y to");
            return false;
        }
        lo = Vec2d(Vec2(screenwindow[0], screenwindow[2]));
        hi = Vec2d(Vec2(screenwindow[1], screenwindow[3]));
        if (lo.x == hi.x || lo.y == hi.y) {
            context.messages.add_error(
                place, "parameter \"screenwindow\" is empty; it must have a width and a height");
            return false;
        }
    }
    corner_ = {lo.x, hi.y};
    step_ = {(hi.x - lo.x) / size.x, (lo.y - hi.y) / size.y};
    return true;
}

CameraRay FlatCamera::make_ray(Vec3d origin, Vec3d direction, float time) const {
    return make_ray_from(Vec3(world_from_camera_.point(origin)), direction, time);
}

std::optional<CameraConnection> FlatCamera::sample_towards(Vec3 p, Vec2 u, float /*time*/) const {
    const Vec3d point = world_from_camera_.inverse_point(Vec3d(p));
    if (!(point.z > 0)) return std::nullopt;
    const Vec2d on_lens = plane_z_ > 0 && lensradius > 0 ? lens(u) : Vec2d();
    // Parallel rays start at the foot of the point.
    const Vec3d from = plane_z_ > 0 ? Vec3d(on_lens.x, on_lens.y, 0) : Vec3d(point.x, point.y, 0);
    const Vec3d v = point - from, on_plane = from + v * (plane_z_ / v.z);
    const Vec3d d = world_from_camera_.vector(v);
    CameraConnection c;
    c.p = Vec3(world_from_camera_.point(from));
    c.d = Vec3(normalize(d));
    c.film = {static_cast<float>((on_plane.x / plane_scale_ - corner_.x) / step_.x),
              static_cast<float>((on_plane.y / plane_scale_ - corner_.y) / step_.y)};
    c.density = density(v, length(d));
    return c;
}

float FlatCamera::ray_density(const Ray& ray, float t) const {
    return density(world_from_camera_.inverse_vector(Vec3d(ray.d)), static_cast<double>(t));
}

// An area dA of the plane, seen along v = (x, y, z) reaching there, covers the solid angle det(M) z dA / |M
// v|^3 of the world, M being the transformation from camera space. Parallel rays are M (0, 0, 1); an area dA
// of their window is det(M) dA / |M (0, 0, 1)| across them.
float FlatCamera::density(Vec3d v, double distance) const {
    if (!(v.z > 0)) return 0;
    const double determinant = std::abs(world_from_camera_.matrix().determinant3());
    const double area =
        std::abs(step_.x * step_.y) * resolution_.x * resolution_.y * plane_scale_ * plane_scale_;
    if (plane_z_ == 0)
        return static_cast<float>(length(world_from_camera_.vector(Vec3d(0, 0, 1))) / (determinant * area));
    const double reach = length(world_from_camera_.vector(v * (plane_z_ / v.z)));
    return static_cast<float>(reach * reach * reach / (determinant * plane_z_ * area * distance * distance));
}

// The inverse of screen(), over the distance to the window's plane: w times it, to be divided by w later.
Projection FlatCamera::projection_of(double half_size, bool is_perspective) const {
    const double across = 1 / (half_size * step_.x), down = 1 / (half_size * step_.y);
    const double left = -corner_.x / step_.x, top = -corner_.y / step_.y;
    Matrix4 film_from_camera;
    if (is_perspective)
        film_from_camera.m = {{{across, 0, left, 0}, {0, down, top, 0}, {0, 0, 1, 0}, {0, 0, 1, 0}}};
    else
        film_from_camera.m = {{{across, 0, 0, left}, {0, down, 0, top}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    return {film_from_camera * world_from_camera_.inverse_matrix(), is_perspective};
}

} // namespace alhazen
