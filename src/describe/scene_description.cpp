#include "describe/scene_description.h"

namespace alhazen {

const Parameter* Node::find(std::string_view parameter) const {
    for (const Parameter& p : parameters)
        if (p.name == parameter) return &p;
    return nullptr;
}

const Place& Node::place_of(std::string_view parameter) const {
    const Parameter* p = find(parameter);
    return p ? p->place : place;
}

void Node::set(Parameter parameter) {
    for (Parameter& p : parameters)
        if (p.name == parameter.name) {
            p = std::move(parameter);
            return;
        }
    parameters.push_back(std::move(parameter));
}

} // namespace alhazen
