/// A node seen from its parent's coordinates, and how operators name their children.
#pragma once

#include <vector>

#include "describe/context.h"
#include "sdf/sdf.h"

namespace alhazen {

/// Immutable. Its field is 1-Lipschitz in the parent's coordinates, whatever the transformation stretches,
/// and outside the bounds at least the distance to them.
class PlacedSdf {
  public:
    /// parent_from_node must be invertible and affine.
    PlacedSdf(std::shared_ptr<const Sdf> sdf, const Matrix4& parent_from_node);

    /// Of a point of the parent's coordinates.
    double value(Vec3d p) const { return at(p); }
    Dual value(TVec3<Dual> p) const { return at(p); }
    /// In the parent's coordinates.
    const Box& bounds() const { return bounds_; }
    double noise() const { return noise_; }

  private:
    template <class S>
    S at(TVec3<S> p) const {
        S f = sdf_->value(to_node(p)) * S(scale_);
        double outside = bounds_.distance(values_of(p));
        if (outside == 0 || value_of(f) >= outside) return f;
        Vec3d q = values_of(p), nearest = min(max(q, bounds_.lo), bounds_.hi);
        return with_gradient(outside, (q - nearest) * (1 / outside), p);
    }
    template <class S>
    TVec3<S> to_node(TVec3<S> p) const {
        if (is_identity_) return p;
        const auto& m = node_from_parent_.m;
        TVec3<S> q;
        for (int i = 0; i < 3; ++i) {
            const auto& row = m[static_cast<std::size_t>(i)];
            q[i] = p.x * S(row[0]) + p.y * S(row[1]) + p.z * S(row[2]) + S(row[3]);
        }
        return q;
    }

    std::shared_ptr<const Sdf> sdf_;
    Matrix4 node_from_parent_;
    bool is_identity_ = false;
    double scale_ = 1; ///< by how much parent_from_node stretches lengths at least
    double noise_ = 0; ///< found once: bodies may share much of what they are made of
    Box bounds_;
};

/// The least factor by which an affine transformation stretches lengths: its smallest singular value, rounded
/// down.
double least_stretch(const Matrix4& m);
/// The largest one, rounded up.
double largest_stretch(const Matrix4& m);

/// Nodes that an operator is applied to, by name.
struct SdfChildren {
    std::vector<std::shared_ptr<const PlacedSdf>> list;
    double noise() const {
        double most = 0;
        for (const auto& child : list) most = std::max(most, child->noise());
        return most;
    }
};
/// One node, by name.
struct SdfChild {
    std::shared_ptr<const PlacedSdf> node;
    const PlacedSdf* operator->() const { return node.get(); }
};

template <>
struct FieldType<SdfChildren> {
    static std::string type_text() { return "string[]"; }
    static std::string default_text(const SdfChildren&) { return "none"; }
    static void read(SdfChildren& out, const Parameter& p, BuildContext& context);
};
template <>
struct FieldType<SdfChild> {
    static std::string type_text() { return "string"; }
    static std::string default_text(const SdfChild&) { return "none"; }
    static void read(SdfChild& out, const Parameter& p, BuildContext& context);
};

/// Adds an error and returns false when the child reaches to infinity, which the operator cannot bear.
bool require_bounded(const SdfChild& child, const Node& node, BuildContext& context);

} // namespace alhazen
