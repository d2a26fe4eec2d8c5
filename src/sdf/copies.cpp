/// Many copies of one body for the price of a few: repeat and mirror.
#include <fmt/format.h>

#include "sdf/placed_sdf.h"

namespace alhazen {

namespace {

struct RepeatSdf final : SdfOf<RepeatSdf> {
    SdfChild child;
    Vec3 spacing{2, 2, 2};
    Vec3 count{2, 2, 1};

    static void describe(Fields<RepeatSdf>& f) {
        f.about(
            "Copies of a body in a grid around the origin. The body must be within half of the spacing from "
            "the origin, along the axes that have several copies.");
        f.field("child", &RepeatSdf::child, "name of an sdf that was defined before").required();
        f.field("spacing", &RepeatSdf::spacing, "from one copy to the next along each axis").above(0);
        f.field("count", &RepeatSdf::count, "copies along each axis; 0 for no end of them").in(0, 1e6);
        f.example("grid", {make_string("child", "small box"), make_point3("spacing", {1.5f, 2, 1}),
                           make_point3("count", {3, 2, 1})});
    }
    void finish(const Node& node, BuildContext& context) {
        const Box& box = child->bounds();
        for (int i = 0; i < 3; ++i) {
            double half = 0.5 * static_cast<double>(spacing[i]), n = static_cast<double>(count[i]);
            if (n != std::floor(n))
                return context.messages.add_error(node.place,
                                                  fmt::format("{} copies; expected a whole number", n));
            if (n != 1 && !(box.lo[i] >= -half && box.hi[i] <= half))
                return context.messages.add_error(
                    node.place,
                    fmt::format("the child reaches from {:.6g} to {:.6g} along {}, but its copies "
                                "stand only {:.6g} apart: it must stay within {:.6g} of the origin",
                                box.lo[i], box.hi[i], "xyz"[i], 2 * half, half));
        }
    }
    // The nearest copies are those of the two nearest cells on each axis; what is in the others is at least
    // as far away as their border.
    template <class S>
    S at(TVec3<S> p) const {
        S least(Box::far);
        std::array<std::array<double, 2>, 3> centres{};
        std::array<int, 3> choices{};
        for (int i = 0; i < 3; ++i) {
            auto k = static_cast<std::size_t>(i);
            choices[k] = nearest_cells(i, value_of(p[i]), centres[k]);
            if (count[i] == 1) continue;
            S from_centre = absolute(p[i] - S(cell_of(i, value_of(p[i]))));
            least = std::min(least, from_centre + S(0.5 * static_cast<double>(spacing[i])));
        }
        for (int a = 0; a < choices[0]; ++a)
            for (int b = 0; b < choices[1]; ++b)
                for (int c = 0; c < choices[2]; ++c) {
                    Vec3d centre{centres[0][static_cast<std::size_t>(a)],
                                 centres[1][static_cast<std::size_t>(b)],
                                 centres[2][static_cast<std::size_t>(c)]};
                    least = std::min(least, child->value(p - TVec3<S>(centre)));
                }
        return least;
    }
    Box bounds() const override {
        Box box = child->bounds();
        for (int i = 0; i < 3; ++i) {
            double more = 0.5 * static_cast<double>((count[i] - 1) * spacing[i]);
            if (count[i] == 0) more = Box::far;
            box.lo[i] -= more;
            box.hi[i] += more;
        }
        return box;
    }
    double noise() const override { return child->noise(); }

  private:
    // Centre of the cell that x is in, or that is nearest to it.
    double cell_of(int axis, double x) const {
        double s = static_cast<double>(spacing[axis]), n = static_cast<double>(count[axis]);
        if (n == 0) return s * std::round(x / s);
        double first = -0.5 * (n - 1);
        return s * (first + std::clamp(std::round(x / s - first), 0.0, n - 1));
    }
    // That cell and its neighbour on the side of x, as far as there is one.
    int nearest_cells(int axis, double x, std::array<double, 2>& centres) const {
        double s = static_cast<double>(spacing[axis]), n = static_cast<double>(count[axis]);
        if (n == 1) {
            centres[0] = 0;
            return 1;
        }
        double cell = cell_of(axis, x), other = x < cell ? cell - s : cell + s;
        centres = {cell, other};
        double last = 0.5 * (n - 1) * s;
        return n == 0 || std::abs(other) <= last + 0.25 * s ? 2 : 1;
    }
};

struct MirrorSdf final : SdfOf<MirrorSdf> {
    SdfChild child;
    std::string axes = "x";

    static void describe(Fields<MirrorSdf>& f) {
        f.about(
            "The half of a body with x >= 0, and its mirror image. With several axes, a quarter or an eighth "
            "and its images.");
        f.field("child", &MirrorSdf::child, "name of an sdf that was defined before").required();
        f.field("axes", &MirrorSdf::axes, "across which axes: \"x\", \"xy\", \"yz\", \"xyz\" ...");
        f.example("pair", {make_string("child", "aside")});
    }
    void finish(const Node& node, BuildContext& context) {
        if (axes.empty() || axes.find_first_not_of("xyz") != std::string::npos)
            return context.messages.add_error(
                node.place_of("axes"),
                fmt::format("parameter \"axes\" is \"{}\"; expected some of the letters x, y and z", axes));
        for (int i = 0; i < 3; ++i)
            is_folded_[static_cast<std::size_t>(i)] = axes.find("xyz"[i]) != std::string::npos;
    }
    template <class S>
    S at(TVec3<S> p) const {
        for (int i = 0; i < 3; ++i)
            if (is_folded_[static_cast<std::size_t>(i)]) p[i] = absolute(p[i]);
        return child->value(p);
    }
    Box bounds() const override {
        Box box = child->bounds();
        for (int i = 0; i < 3; ++i)
            if (is_folded_[static_cast<std::size_t>(i)]) {
                box.hi[i] = std::max(0.0, box.hi[i]);
                box.lo[i] = -box.hi[i];
            }
        return box;
    }
    double noise() const override { return child->noise(); }

  private:
    std::array<bool, 3> is_folded_{};
};

} // namespace

Kind<Sdf> repeat_sdf() {
    return make_kind<Sdf, RepeatSdf>("repeat");
}
Kind<Sdf> mirror_sdf() {
    return make_kind<Sdf, MirrorSdf>("mirror");
}

} // namespace alhazen
