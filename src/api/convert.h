/// Between the public types of <alhazen/alhazen.h> and the house's own.
#pragma once

#include "base/messages.h"
#include "describe/scene_description.h"
#include <alhazen/alhazen.h>

namespace alhazen {

std::vector<Notice> to_notices(const std::vector<Message>& messages);
InputError to_input_error(const SceneError& error);
/// An error with one notice, about owner.
InputError make_input_error(const std::string& owner, const std::string& text);

/// The setting as a parameter of owner ("material \"clay\""). Throws InputError when its numbers do not fit
/// its type.
Parameter to_parameter(Setting setting, const std::string& owner);
Node to_node(std::string kind, std::string name, Settings settings, const std::string& owner);
Motion to_motion(const Pose& pose);
/// x y z x y z ... to vectors; a length that is no multiple of three throws InputError.
std::vector<Vec3> to_vec3s(const std::vector<float>& numbers, const std::string& owner);
std::vector<Vec2> to_vec2s(const std::vector<float>& numbers, const std::string& owner);

} // namespace alhazen
