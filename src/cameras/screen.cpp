#include "cameras/screen.h"

namespace alhazen {

Place camera_place(const Node& node, std::string_view parameter) {
    const Parameter* p = node.find(parameter);
    return p ? p->place : node.place;
}

void check_shutter(Camera& camera, const Node& node, BuildContext& context) {
    if (camera.shutterclose >= camera.shutteropen) return;
    context.messages.add_warning(camera_place(node, "shutterclose"),
                                 "the shutter closes before it opens; the two times are exchanged");
    std::swap(camera.shutteropen, camera.shutterclose);
}

bool FlatCamera::finish_flat(const Node& node, BuildContext& context) {
    check_shutter(*this, node, context);
    world_from_camera_ = context.world_from_node;
    const Vec2d size(context.film_resolution);
    const double aspect = frameaspectratio ? static_cast<double>(*frameaspectratio) : size.x / size.y;
    Vec2d lo = aspect > 1 ? Vec2d(-aspect, -1) : Vec2d(-1, -1 / aspect);
    Vec2d hi = -lo;
    if (!screenwindow.empty()) {
        Place place = camera_place(node, "screenwindow");
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
    Vec3d d = world_from_camera_.vector(direction);
    return {{Vec3(world_from_camera_.point(origin)), Vec3(normalize(d)), infinity, time}, 1};
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
