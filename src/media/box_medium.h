/// What media in a box share: where the box is, and places in it.
#pragma once

#include "media/medium.h"

namespace alhazen {

struct BoxMedium : Medium {
    Vec3 p0{0}, p1{1};

  protected:
    template <class T>
    static void describe_box(Fields<T>& f) {
        f.field("p0", &T::p0, "one corner of the box that it fills");
        f.field("p1", &T::p1, "the opposite corner");
        Medium::describe_common(f);
    }
    /// Sets box, placement and phase; false with an error added when there is no box.
    bool place_box(const Node& node, BuildContext& context) {
        box_ = Bounds3();
        box_.extend(p0);
        box_.extend(p1);
        world_from_medium_ = context.world_from_node;
        phase_ = HenyeyGreenstein(g);
        const Vec3 size = box_.diagonal();
        per_size_ = {1 / size.x, 1 / size.y, 1 / size.z};
        if (size.x > 0 && size.y > 0 && size.z > 0 && is_finite(per_size_)) return true;
        context.messages.add_error(node.place,
                                   "the box of this medium, from \"p0\" to \"p1\", has no volume");
        return false;
    }
    /// From the medium's own space to the unit cube that the box becomes.
    Vec3 in_unit_cube(Vec3 p) const { return (p - box_.lo) * per_size_; }
    Bounds3 in_unit_cube(const Bounds3& b) const { return {in_unit_cube(b.lo), in_unit_cube(b.hi)}; }

    Bounds3 box_;

  private:
    Vec3 per_size_;
};

} // namespace alhazen
