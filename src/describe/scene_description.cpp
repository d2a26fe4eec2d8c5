#include "describe/scene_description.h"

namespace alhazen {

const Parameter* Node::find(std::string_view parameter) const {
    for (const Parameter& p : parameters)
        if (p.name == parameter) return &p;
    return nullptr;
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
