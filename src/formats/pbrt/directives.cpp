#include "formats/pbrt/directives.h"

#include <algorithm>

namespace alhazen {

using Kind = PbrtToken::Kind;

const std::vector<DirectiveTable::Entry> DirectiveTable::entries{
    {"Accelerator", with_node<&B::accelerator>},
    {"ActiveTransform",
     [](P& p, B& b, Place at) {
         PbrtToken which = p.tokens().next();
         b.active_transform(which.kind == Kind::word ? which.text : "", std::move(at));
     }},
    {"AreaLightSource", with_node<&B::area_light_source>},
    {"Attribute",
     [](P& p, B& b, Place at) {
         Node node = p.node(at, true);
         b.attribute(std::move(node), std::move(at));
     }},
    {"AttributeBegin", [](P&, B& b, Place at) { b.attribute_begin("AttributeBegin", std::move(at)); }},
    {"AttributeEnd", [](P&, B& b, Place at) { b.attribute_end("AttributeEnd", std::move(at)); }},
    {"Camera", with_node<&B::camera>},
    {"ColorSpace", with_name<&B::color_space>},
    {"ConcatTransform",
     [](P& p, B& b, Place at) { b.concat_transform(p.matrix("ConcatTransform"), std::move(at)); }},
    {"CoordSysTransform", with_name<&B::coord_sys_transform>},
    {"CoordinateSystem", with_name<&B::coordinate_system>},
    {"Film", with_node<&B::film>},
    {"Identity", alone<&B::identity>},
    {"Import", [](P& p, B&, Place at) { p.import(p.string("a file name"), std::move(at)); }},
    {"Include", [](P& p, B&, Place at) { p.resolve_and_parse(p.string("a file name"), at); }},
    {"Integrator", with_node<&B::integrator>},
    {"LightSource", with_node<&B::light_source>},
    {"LookAt",
     [](P& p, B& b, Place at) {
         auto v = p.numbers<9>("LookAt");
         b.look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, std::move(at));
     }},
    {"MakeNamedMaterial", with_node<&B::make_named_material>},
    {"MakeNamedMedium",
     [](P& p, B& b, Place at) {
         Node node = p.node(at, true);
         b.make_named_medium(std::move(node), std::move(at));
     }},
    {"Material", with_node<&B::material>},
    {"MediumInterface", [](P& p, B&, Place at) { p.medium_interface(std::move(at)); }},
    {"NamedMaterial", with_own_name<&B::named_material>},
    {"ObjectBegin", with_own_name<&B::object_begin>},
    {"ObjectEnd", alone<&B::object_end>},
    {"ObjectInstance", with_own_name<&B::object_instance>},
    {"Option", [](P& p, B&, Place at) { p.option(std::move(at)); }},
    {"PixelFilter", with_node<&B::filter>},
    {"ReverseOrientation", alone<&B::reverse_orientation>},
    {"Rotate",
     [](P& p, B& b, Place at) {
         auto v = p.numbers<4>("Rotate");
         b.rotate(v[0], {v[1], v[2], v[3]}, std::move(at));
     }},
    {"Sampler", with_node<&B::sampler>},
    {"Scale",
     [](P& p, B& b, Place at) {
         auto v = p.numbers<3>("Scale");
         b.scale({v[0], v[1], v[2]}, std::move(at));
     }},
    {"Sdf", [](P& p, B&, Place at) { p.sdf(std::move(at)); }},
    {"Shape", with_node<&B::shape>},
    {"Texture", [](P& p, B&, Place at) { p.texture(std::move(at)); }},
    {"Transform", [](P& p, B& b, Place at) { b.transform(p.matrix("Transform"), std::move(at)); }},
    {"TransformBegin",
     [](P&, B& b, Place at) {
         b.warn_transform_blocks(at);
         b.attribute_begin("TransformBegin", std::move(at));
     }},
    {"TransformEnd", [](P&, B& b, Place at) { b.attribute_end("TransformEnd", std::move(at)); }},
    {"TransformTimes",
     [](P& p, B& b, Place at) {
         auto v = p.numbers<2>("TransformTimes");
         b.transform_times(v[0], v[1], std::move(at));
     }},
    {"Translate",
     [](P& p, B& b, Place at) {
         auto v = p.numbers<3>("Translate");
         b.translate({v[0], v[1], v[2]}, std::move(at));
     }},
    {"WorldBegin", alone<&B::world_begin>},
};

const DirectiveTable::Entry* DirectiveTable::find(std::string_view word) {
    auto at = std::lower_bound(entries.begin(), entries.end(), word,
                               [](const Entry& e, std::string_view w) { return e.word < w; });
    return at != entries.end() && at->word == word ? &*at : nullptr;
}

} // namespace alhazen
