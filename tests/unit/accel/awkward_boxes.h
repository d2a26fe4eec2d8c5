/// Inputs that upset builders.
#pragma once

#include <string>
#include <vector>

#include "tests/unit/accel/support.h"

namespace alhazen::accel_test {

struct NamedBoxes {
    std::string name;
    std::vector<Bounds3> boxes;
};

inline std::vector<NamedBoxes> awkward_boxes() {
    std::vector<NamedBoxes> all;
    for (std::size_t n : {0u, 1u, 2u, 3u, 4u, 5u})
        all.push_back({std::to_string(n) + " boxes", random_triangles(n, 1, 0.1f, n).boxes()});
    all.push_back({"coincident", std::vector<Bounds3>(10000, Bounds3{{1, 2, 3}, {4, 5, 6}})});

    NamedBoxes nested{"nested", {}};
    for (int i = 0; i < 3000; ++i) {
        auto r = static_cast<float>(i);
        nested.boxes.push_back({{-r, -r, -r}, {r, r, r}});
    }
    all.push_back(nested);

    NamedBoxes geometric{"geometric", {}};
    for (int copy = 0; copy < 20; ++copy)
        for (int i = -120; i < 120; ++i) {
            float p = std::ldexp(1.0f, i);
            geometric.boxes.push_back({{p, p, p}, {p * 1.01f, p * 1.01f, p * 1.01f}});
        }
    all.push_back(geometric);

    NamedBoxes huge{"huge and tiny", {}};
    Rng rng(3);
    for (int i = 0; i < 2000; ++i) {
        Vec3 p = random_point(rng, 1) * (i % 2 ? 3.3e38f : 1e-42f);
        huge.boxes.push_back({p, p});
    }
    huge.boxes.push_back({{-3.4e38f, -3.4e38f, -3.4e38f}, {3.4e38f, 3.4e38f, 3.4e38f}});
    all.push_back(huge);

    NamedBoxes flat{"points on a line, some of them empty", {}};
    for (int i = 0; i < 1000; ++i) {
        auto x = static_cast<float>(i * 37 % 1000);
        flat.boxes.push_back(i % 10 == 3 ? Bounds3{} : Bounds3{{x, 0, 0}, {x, 0, 0}});
    }
    all.push_back(flat);
    return all;
}

/// Boxes of many sizes, some of which coincide, some with zeros of both signs.
inline std::vector<Bounds3> mixed_boxes(std::size_t count, std::uint64_t seed) {
    auto boxes = random_triangles(count, 1, 0.01f, seed).boxes();
    for (std::size_t i = 0; i < boxes.size(); i += 7) boxes[i] = boxes[i / 2];
    for (std::size_t i = 3; i < boxes.size(); i += 11) boxes[i].lo.x = -0.0f, boxes[i].hi.x = 0.0f;
    for (std::size_t i = 5; i < boxes.size(); i += 101) boxes[i].hi += Vec3{0.3f, 0.02f, 0.1f};
    return boxes;
}

} // namespace alhazen::accel_test
