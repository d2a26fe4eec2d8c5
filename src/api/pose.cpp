#include <alhazen/alhazen.h>

#include "api/convert.h"
#include "base/transform.h"

namespace alhazen {

namespace {

Vec3d to_vec3d(Pose::Point p) {
    return {p[0], p[1], p[2]};
}

Pose to_pose(const Matrix4& matrix) {
    Pose pose;
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            pose.matrix[4 * row + column] = matrix.m[row][column];
    return pose;
}

} // namespace

Pose Pose::translate(double x, double y, double z) {
    return to_pose(Matrix4::translate({x, y, z}));
}

Pose Pose::scale(double x, double y, double z) {
    return to_pose(Matrix4::scale({x, y, z}));
}

Pose Pose::rotate(double degrees, Point axis) {
    if (axis == Point{0, 0, 0}) throw make_input_error("Pose::rotate", "the axis is zero");
    return to_pose(Matrix4::rotate(degrees, to_vec3d(axis)));
}

Pose Pose::look_at(Point eye, Point target, Point up) {
    auto camera_from_world = Matrix4::look_at(to_vec3d(eye), to_vec3d(target), to_vec3d(up));
    auto world_from_camera = camera_from_world ? camera_from_world->inverse() : std::nullopt;
    if (!world_from_camera)
        throw make_input_error("Pose::look_at", "eye and target are the same, or up is parallel to the view");
    return to_pose(*world_from_camera);
}

Pose operator*(const Pose& a, const Pose& b) {
    return to_pose(to_motion(a).start * to_motion(b).start);
}

} // namespace alhazen
