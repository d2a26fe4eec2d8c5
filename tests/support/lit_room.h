/// A corner of a room and a lamp, as scene text.
#pragma once

#include <string>

namespace alhazen::testing {

inline const std::string floor_and_wall = R"(
Material "diffuse" "rgb reflectance" [ .7 .6 .5 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 0 1  2 0 1 ]
Shape "bilinearmesh" "point3 P" [ -2 0 1  2 0 1  -2 3 1  2 3 1 ]
)";
inline const std::string lamp = R"(
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 6 5 4 ]
Shape "bilinearmesh" "point3 P" [ -.5 1.9 -.5  .5 1.9 -.5  -.5 1.9 .5  .5 1.9 .5 ]
AttributeEnd
)";

} // namespace alhazen::testing
