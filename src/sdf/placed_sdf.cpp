#include "sdf/placed_sdf.h"

#include <fmt/format.h>

#include "sdf/sdf_set.h"

namespace alhazen {

namespace {

// Turns columns p and q of m until they are orthogonal; returns how far they were from it.
double make_orthogonal(std::array<Vec3d, 3>& columns, std::size_t p, std::size_t q) {
    double pp = dot(columns[p], columns[p]), qq = dot(columns[q], columns[q]);
    double pq = dot(columns[p], columns[q]);
    if (std::abs(pq) <= 1e-16 * std::sqrt(pp * qq)) return 0;
    double zeta = (qq - pp) / (2 * pq);
    double t = (zeta < 0 ? -1 : 1) / (std::abs(zeta) + std::sqrt(1 + zeta * zeta));
    double c = 1 / std::sqrt(1 + t * t), s = c * t;
    Vec3d turned = columns[p] * c - columns[q] * s;
    columns[q] = columns[p] * s + columns[q] * c;
    columns[p] = turned;
    return std::abs(pq) / std::sqrt(pp * qq);
}

} // namespace

namespace {

// One-sided Jacobi rotations (Hestenes 1958): the columns' lengths become the singular values.
std::array<double, 3> stretches(const Matrix4& m) {
    std::array<Vec3d, 3> columns;
    for (std::size_t j = 0; j < 3; ++j) columns[j] = {m.m[0][j], m.m[1][j], m.m[2][j]};
    for (int sweep = 0; sweep < 60; ++sweep) {
        double off =
            make_orthogonal(columns, 0, 1) + make_orthogonal(columns, 0, 2) + make_orthogonal(columns, 1, 2);
        if (off < 1e-15) break;
    }
    return {length(columns[0]), length(columns[1]), length(columns[2])};
}

} // namespace

double least_stretch(const Matrix4& m) {
    const std::array<double, 3> all = stretches(m);
    return *std::min_element(all.begin(), all.end()) * (1 - 1e-14);
}

double largest_stretch(const Matrix4& m) {
    const std::array<double, 3> all = stretches(m);
    return *std::max_element(all.begin(), all.end()) * (1 + 1e-14);
}

PlacedSdf::PlacedSdf(std::shared_ptr<const Sdf> sdf, const Matrix4& parent_from_node)
    : sdf_(std::move(sdf)), node_from_parent_(parent_from_node.inverse().value_or(Matrix4{})),
      is_identity_(parent_from_node == Matrix4{}), scale_(is_identity_ ? 1 : least_stretch(parent_from_node)),
      noise_(sdf_->noise() * scale_), bounds_(transformed(parent_from_node, sdf_->bounds())) {}

namespace {

void find_child(std::vector<std::shared_ptr<const PlacedSdf>>& out, const std::string& name,
                const Parameter& p, BuildContext& context) {
    std::vector<std::string> known;
    if (context.sdfs) {
        if (auto child = context.sdfs->find(name)) return out.push_back(std::move(child));
        if (context.sdfs->has(name)) { // its errors have been told
            context.messages.add_error(p.place, fmt::format("sdf \"{}\" could not be made", name));
            return;
        }
        known = context.sdfs->names();
    }
    context.messages.add_error(
        p.place, fmt::format("no sdf \"{}\" is defined before this{}", name, did_you_mean(name, known)));
}

} // namespace

void FieldType<SdfChildren>::read(SdfChildren& out, const Parameter& p, BuildContext& context) {
    std::vector<std::string> names;
    FieldType<std::vector<std::string>>::read(names, p, context);
    for (const std::string& name : names) find_child(out.list, name, p, context);
    if (p.count() == 0) report_wrong_count(p, "at least one", context);
}

void FieldType<SdfChild>::read(SdfChild& out, const Parameter& p, BuildContext& context) {
    std::string name;
    std::size_t errors = context.messages.error_count();
    FieldType<std::string>::read(name, p, context);
    if (context.messages.error_count() != errors) return;
    std::vector<std::shared_ptr<const PlacedSdf>> found;
    find_child(found, name, p, context);
    if (!found.empty()) out.node = std::move(found.front());
}

bool require_bounded(const SdfChild& child, const Node& node, BuildContext& context) {
    if (child->bounds().is_bounded()) return true;
    context.messages.add_error(node.place,
                               fmt::format("sdf \"{}\" needs a child that ends somewhere; intersect it with "
                                           "a box or a sphere first",
                                           node.type));
    return false;
}

} // namespace alhazen
