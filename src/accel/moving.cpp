#include "accel/moving.h"

namespace alhazen {

MovingStructure::MovingStructure(const Primitives& primitives, AccelChoice choice)
    : choice_(std::move(choice)) {
    rebuild(primitives);
}

void MovingStructure::rebuild(const Primitives& primitives) {
    tree_ = build_tree(primitives, choice_);
    structure_ = make_structure(primitives, tree_, choice_);
}

bool MovingStructure::update(const Primitives& primitives) {
    if (!refit(tree_, padded_boxes(primitives))) {
        rebuild(primitives);
        return false;
    }
    structure_ = make_structure(primitives, tree_, choice_);
    return true;
}

} // namespace alhazen
