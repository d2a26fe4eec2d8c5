#include "sdf/mesh_grid.h"

#include <atomic>
#include <mutex>
#include <stdexcept>

#include "base/threads.h"
#include "sdf/solid_parts.h"

namespace alhazen {

namespace {

class MeshSampler {
  public:
    MeshSampler(MeshParts parts, const MeshGridOptions& options)
        : solid_(std::move(parts.solid)), sheets_(std::move(parts.sheets)), options_(options) {
        Bounds3 box = solid_.bounds();
        box.extend(sheets_.bounds());
        const Vec3d size(box.diagonal());
        double longest = max_component(size);
        if (solid_.count() + sheets_.count() == 0 || !(longest > 0) || !std::isfinite(longest))
            throw std::runtime_error("the mesh has no extent");
        spacing_ = longest / options.resolution;
        for (int i = 0; i < 3; ++i)
            data_.hi[i] = static_cast<int>(std::ceil(size[i] / spacing_)) + 2 * options.band;
        Vec3d centre = (Vec3d(box.lo) + Vec3d(box.hi)) * 0.5;
        data_.object_from_index =
            Matrix4::translate(centre - Vec3d(data_.hi) * (0.5 * spacing_)) * Matrix4::scale(Vec3d(spacing_));
        data_.background = static_cast<float>(options.band * spacing_);
        bricks_ = {data_.hi.x / 8 + 1, data_.hi.y / 8 + 1, data_.hi.z / 8 + 1};
    }

    GridData run(const std::function<bool(double)>& progress) {
        auto total = static_cast<std::size_t>(bricks_.x) * static_cast<std::size_t>(bricks_.y) *
                     static_cast<std::size_t>(bricks_.z);
        std::vector<GridBrick> bricks(total);
        std::vector<char> is_kept(total, 0);
        std::atomic<std::size_t> done{0};
        std::atomic<bool> is_stopped{false};
        std::mutex mutex;
        parallel_for(total, 1, [&](std::size_t i) {
            if (is_stopped) return;
            auto x = static_cast<std::size_t>(bricks_.x), y = static_cast<std::size_t>(bricks_.y);
            bricks[i].origin = {8 * static_cast<int>(i % x), 8 * static_cast<int>(i / x % y),
                                8 * static_cast<int>(i / (x * y))};
            is_kept[i] = sample(bricks[i]);
            std::size_t so_far = ++done;
            std::unique_lock lock(mutex, std::try_to_lock);
            if (lock && progress && !progress(static_cast<double>(so_far) / static_cast<double>(total)))
                is_stopped = true;
        });
        for (std::size_t i = 0; i < total; ++i)
            if (is_kept[i]) data_.bricks.push_back(bricks[i]);
        return std::move(data_);
    }

  private:
    // Whether the brick belongs to the grid.
    bool sample(GridBrick& brick) const {
        Vec3d centre = data_.object_from_index.point(Vec3d(brick.origin) + Vec3d(3.5));
        double half_diagonal = 3.5 * std::sqrt(3.0) * spacing_, band = options_.band * spacing_;
        const double far = static_cast<double>(infinity);
        const double to_solid = distance(solid_, centre, far), to_sheets = distance(sheets_, centre, far);
        if (!options_.is_full && std::min(to_solid, to_sheets) > half_diagonal + band) return false;
        for (int i = 0; i < static_cast<int>(GridBrick::samples); ++i) {
            Vec3d q = Vec3d(brick.origin) + Vec3d{static_cast<double>(i & 7), static_cast<double>(i >> 3 & 7),
                                                  static_cast<double>(i >> 6)};
            Vec3d p = data_.object_from_index.point(q);
            // No point is farther than the middle's nearest.
            auto limit = [&](double at_middle) {
                return (at_middle + length(p - centre)) * (1 + 1e-9) + 1e-30;
            };
            double d = distance(solid_, p, limit(to_solid));
            if (solid_.is_inside(p)) d = -d;
            d = std::min(d, distance(sheets_, p, limit(to_sheets)) - half_thickness * spacing_);
            brick.values[static_cast<std::size_t>(i)] = static_cast<float>(d);
        }
        return true;
    }

    // From the nearest triangle, the limit where none is nearer.
    static double distance(const MeshDistance& mesh, Vec3d p, double limit) {
        const auto nearest = mesh.nearest(p, limit);
        return nearest ? nearest->distance : limit;
    }

    // Of a sheet's wall, in cells: between two samples, half a cell from either, there must be some of it.
    static constexpr double half_thickness = 0.75;

    MeshDistance solid_, sheets_;
    const MeshGridOptions& options_;
    GridData data_;
    double spacing_ = 1;
    Vec3i bricks_;
};

} // namespace

GridData sample_mesh(const std::vector<Corners>& triangles, const MeshGridOptions& options,
                     const std::function<bool(double)>& progress) {
    return MeshSampler(mesh_parts(triangles, options.is_one_body), options).run(progress);
}

} // namespace alhazen
