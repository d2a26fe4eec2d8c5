#include "benchmarks/accel/meshes.h"

#include <array>
#include <cmath>

#include "base/hash.h"
#include "base/transform.h"
#include "math/warp.h"

namespace alhazen::bench {

namespace {

/// Triangles over shared vertices, with ways to add more.
struct Mesh {
    std::vector<Vec3> points;
    std::vector<int> indices;

    int next() const { return static_cast<int>(points.size()); }
    void triangle(int a, int b, int c) { indices.insert(indices.end(), {a, b, c}); }
    void quad(int a, int b, int c, int d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }
    // A row of rows of points, added before, as a surface of quads.
    void grid(int first, int across, int down) {
        for (int j = 0; j + 1 < down; ++j)
            for (int i = 0; i + 1 < across; ++i) {
                int a = first + j * across + i;
                quad(a, a + 1, a + across + 1, a + across);
            }
    }
    // Turned around its vertical axis.
    void box(Vec3 lo, Vec3 hi, float angle = 0) {
        int first = next();
        Vec3 centre = (lo + hi) * 0.5f;
        for (int corner = 0; corner < 8; ++corner) {
            Vec3 q =
                Vec3{corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z} - centre;
            points.push_back(centre + Vec3{q.x * std::cos(angle) - q.z * std::sin(angle), q.y,
                                           q.x * std::sin(angle) + q.z * std::cos(angle)});
        }
        for (const std::array<int, 4>& f :
             {std::array{0, 1, 3, 2}, std::array{4, 6, 7, 5}, std::array{0, 4, 5, 1}, std::array{2, 3, 7, 6},
              std::array{0, 2, 6, 4}, std::array{1, 5, 7, 3}})
            quad(first + f[0], first + f[1], first + f[2], first + f[3]);
    }
    // With bumps of that fraction of the radius.
    void ball(Vec3 centre, float radius, int rings, float bumps) {
        int first = next(), across = 2 * rings + 1;
        for (int j = 0; j <= rings; ++j)
            for (int i = 0; i < across; ++i) {
                float theta = pi * static_cast<float>(j) / static_cast<float>(rings);
                float phi = pi * static_cast<float>(i) / static_cast<float>(rings);
                float r = radius * (1 + bumps * std::sin(7 * phi) * std::sin(9 * theta));
                points.push_back(centre + Vec3{std::sin(theta) * std::cos(phi), std::cos(theta),
                                               std::sin(theta) * std::sin(phi)} *
                                              r);
            }
        grid(first, across, rings + 1);
    }
};

/// Where the camera is, and the lamp: a square facing down.
struct Setting {
    Vec3 eye, target;
    float fov = 60;
    Vec3 lamp;
    float lamp_size = 1;
};

SceneDescription scene_of(Mesh mesh, const Setting& setting) {
    SceneDescription scene;
    CameraNode camera;
    camera.node.type = "perspective";
    camera.node.set(make_float("fov", setting.fov));
    Matrix4 view = *Matrix4::look_at(Vec3d(setting.eye), Vec3d(setting.target), Vec3d(0, 1, 0));
    camera.world_from_camera.start = camera.world_from_camera.end = *view.inverse();
    scene.cameras.push_back(std::move(camera));
    scene.film.type = "rgb";
    scene.film.set(make_integer("xresolution", 512));
    scene.film.set(make_integer("yresolution", 512));

    ShapeNode shape;
    shape.node.type = "trianglemesh";
    shape.node.set(make_array("P", ValueType::point3, std::move(mesh.points)));
    shape.node.set(make_array("indices", ValueType::integer, std::move(mesh.indices)));
    scene.world.shapes.push_back(std::move(shape));

    Node light;
    light.type = "diffuse";
    light.set(make_bool("twosided", true));
    scene.area_lights.push_back(light);
    float r = setting.lamp_size;
    ShapeNode lamp;
    lamp.node.type = "trianglemesh";
    lamp.area_light = 0;
    std::vector<Vec3> corners;
    for (Vec2 c : {Vec2{-r, -r}, Vec2{r, -r}, Vec2{r, r}, Vec2{-r, r}})
        corners.push_back(setting.lamp + Vec3{c.x, 0, c.y});
    lamp.node.set(make_array("P", ValueType::point3, std::move(corners)));
    lamp.node.set(make_array("indices", ValueType::integer, std::vector<int>{0, 1, 2, 0, 2, 3}));
    scene.world.shapes.push_back(std::move(lamp));
    return scene;
}

// Smooth noise in 0 ... 1 with a knot at each whole number.
float noise(float x, float y) {
    float fx = std::floor(x), fy = std::floor(y);
    auto knot = [&](int i, int j) {
        return unit_float(hash_of(static_cast<std::uint32_t>(static_cast<int>(fx) + i),
                                  static_cast<std::uint32_t>(static_cast<int>(fy) + j)));
    };
    auto smooth = [](float t) { return t * t * (3 - 2 * t); };
    float u = smooth(x - fx), v = smooth(y - fy);
    float low = std::lerp(knot(0, 0), knot(1, 0), u), high = std::lerp(knot(0, 1), knot(1, 1), u);
    return std::lerp(low, high, v);
}

/// side x side points, 10 across; ten octaves of noise.
SceneDescription terrain(int side) {
    Mesh mesh;
    mesh.points.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            float x = static_cast<float>(i) / static_cast<float>(side - 1);
            float y = static_cast<float>(j) / static_cast<float>(side - 1);
            float height = 0, amplitude = 0.12f, frequency = 6;
            for (int octave = 0; octave < 10; ++octave) {
                float shift = static_cast<float>(octave);
                height += amplitude * noise(x * frequency + shift * 17.3f, y * frequency + shift * 9.1f);
                amplitude *= 0.5f;
                frequency *= 2.03f;
            }
            mesh.points.push_back(Vec3{x, height, y} * 10);
        }
    mesh.grid(0, side, side);
    return scene_of(std::move(mesh), {{1, 3.2f, 1}, {7, 0.4f, 7}, 60, {9, 7, 1}, 0.7f});
}

/// Curly strands out of a ball, each a prism of three sides, a hundred times as long as thick.
SceneDescription hair(int strands, int segments) {
    Mesh mesh;
    Rng rng(12345);
    auto random_vector = [&] {
        float x = rng.uniform() * 2 - 1, y = rng.uniform() * 2 - 1;
        return Vec3{x, y, rng.uniform() * 2 - 1};
    };
    constexpr float radius = 0.0015f;
    for (int strand = 0; strand < strands; ++strand) {
        Vec3 d = normalize(random_vector() + Vec3{1e-4f, 0, 0}), p = d * 0.15f, curl = random_vector() * 0.5f;
        Vec3 up = std::abs(d.x) < 0.5f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        int first = mesh.next();
        for (int s = 0; s <= segments; ++s) {
            Vec3 a = normalize(cross(d, up)), b = cross(d, a);
            for (int k = 0; k < 3; ++k) {
                float angle = static_cast<float>(k) * (2 * pi / 3);
                mesh.points.push_back(p + a * (radius * std::cos(angle)) + b * (radius * std::sin(angle)));
            }
            d = normalize(d + cross(d, curl) * 0.25f + random_vector() * 0.125f + p * 0.05f);
            p += d * (1.2f / static_cast<float>(segments));
        }
        for (int s = 0; s < segments; ++s)
            for (int k = 0; k < 3; ++k) {
                int a = first + 3 * s + k, b = first + 3 * s + (k + 1) % 3;
                mesh.quad(a, b, b + 3, a + 3);
            }
    }
    return scene_of(std::move(mesh), {{0.2f, 0.3f, 2.4f}, {0, 0, 0}, 50, {2.5f, 3, 2}, 0.5f});
}

// One bay of the hall at x, on the side z: a column of slats with a bumpy core, an arch, a railing.
void add_bay(Mesh& mesh, float x, float z) {
    for (float lift : {0.0f, 0.001f, 0.002f}) mesh.ball({x, 2 + lift, z}, 0.25f, 20, 0.05f);
    for (int i = 0; i < 24; ++i) {
        float angle = static_cast<float>(i) * (pi / 12);
        Vec3 c{x + 0.3f * std::cos(angle), 2, z + 0.3f * std::sin(angle)};
        mesh.box(c - Vec3{0.02f, 2, 0.02f}, c + Vec3{0.02f, 2, 0.02f}, angle);
    }
    mesh.box({x - 0.4f, 4, z - 0.4f}, {x + 0.4f, 4.2f, z + 0.4f});
    for (int i = 0; i < 40; ++i) {
        float angle = pi * static_cast<float>(i) / 39;
        Vec3 c{x + 1.22f - 1.22f * std::cos(angle), 4.2f + 1.2f * std::sin(angle), z};
        mesh.box(c - Vec3{0.06f, 0.06f, 0.3f}, c + Vec3{0.06f, 0.06f, 0.3f});
    }
    for (int i = 0; i < 30; ++i) {
        float at = x + 0.08f * static_cast<float>(i);
        mesh.box({at, 5.6f, z - 0.02f}, {at + 0.02f, 6.4f, z + 0.02f});
    }
    mesh.box({x, 6.4f, z - 0.05f}, {x + 2.45f, 6.5f, z + 0.05f});
}

/// A nave between columns: long thin boxes, large walls, much that is hidden. Statues: bumpy balls of as many
/// rings, or none.
SceneDescription hall(int statue_rings) {
    Mesh mesh;
    mesh.box({-15, -0.2f, -4}, {15, 0, 4});
    for (float z : {-4.2f, 4.0f}) mesh.box({-15, 0, z}, {15, 12, z + 0.2f});
    for (float x : {-15.2f, 15.0f}) mesh.box({x, 0, -4}, {x + 0.2f, 12, 4});
    for (float z : {-2.6f, 2.6f})
        for (int k = 0; k < 12; ++k) add_bay(mesh, -13.5f + 2.45f * static_cast<float>(k), z);
    for (int k = 0; k < 60; ++k) {
        float x = -14 + 0.47f * static_cast<float>(k);
        mesh.box({x, 11, -4}, {x + 0.1f, 11.2f, 4}, 0.3f);
    }
    for (int k = 0; statue_rings > 0 && k < 8; ++k)
        for (float z : {-1.1f, 1.1f})
            mesh.ball({-12 + 3 * static_cast<float>(k), 1.3f, z}, 0.7f, statue_rings, 0.2f);
    return scene_of(std::move(mesh), {{-13, 3, 0.5f}, {10, 4, -0.5f}, 60, {2, 10.5f, 1}, 1});
}

/// A single bumpy ball: what a structure costs where there is little to do.
SceneDescription ball() {
    Mesh mesh;
    mesh.ball({0, 0, 0}, 1, 16, 0.1f);
    return scene_of(std::move(mesh), {{0, 1, 3}, {0, 0, 0}, 50, {2, 4, 2}, 0.5f});
}

/// Two small balls of many triangles on the field of a stadium of few: the teapot in it.
SceneDescription stadium() {
    Mesh mesh;
    mesh.ball({0, 0.25f, 0}, 0.25f, 120, 0.2f);
    mesh.ball({1, 0.4f, 0.3f}, 0.4f, 90, 0.1f);
    mesh.box({-300, -0.1f, -300}, {300, 0, 300});
    constexpr int around = 256, rows = 60;
    for (int row = 0; row < rows; ++row) {
        float r = 60 + 1.2f * static_cast<float>(row), y = 0.8f * static_cast<float>(row);
        int first = mesh.next();
        for (Vec2 edge : {Vec2{r, y}, Vec2{r, y + 0.8f}, Vec2{r + 1.2f, y + 0.8f}})
            for (int k = 0; k <= around; ++k) {
                float angle = 2 * pi * static_cast<float>(k) / around;
                mesh.points.push_back({edge.x * std::cos(angle), edge.y, 1.4f * edge.x * std::sin(angle)});
            }
        mesh.grid(first, around + 1, 3);
    }
    return scene_of(std::move(mesh), {{0.2f, 1.1f, 3}, {0, 0.35f, 0}, 60, {8, 30, 12}, 4});
}

} // namespace

std::vector<GeneratedScene> generated_scenes() {
    return {
        {"ball", "a bumpy ball of a thousand triangles", false, [] { return ball(); }},
        {"hall", "a hall of columns and railings", true, [] { return hall(0); }},
        {"stadium", "two small balls in a huge stadium", true, [] { return stadium(); }},
        {"terrain-1m", "a terrain of a million triangles", true, [] { return terrain(708); }},
        {"hair", "1.9 million slivers", true, [] { return hair(8000, 40); }},
        {"museum", "the hall with statues", false, [] { return hall(170); }},
        {"gallery", "the hall with statues, half a million triangles", false, [] { return hall(75); }},
        {"terrain-10m", "a terrain of ten million triangles", false, [] { return terrain(2237); }},
    };
}

} // namespace alhazen::bench
