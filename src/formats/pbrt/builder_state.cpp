/// The directives that change what follows: transformations, attributes, blocks.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "formats/pbrt/builder.h"
#include "formats/pbrt/tokenizer.h"

namespace alhazen {

namespace {

// No scene nests so deep; a broken exporter's may, and each level holds a copy of the state.
constexpr std::size_t deepest_nesting = 10000;

Matrix4 from_columns(const std::array<double, 16>& m) {
    Matrix4 matrix;
    for (std::size_t i = 0; i < 16; ++i) matrix.m[i % 4][i / 4] = m[i];
    return matrix;
}

} // namespace

template <class Text>
void PbrtBuilder::apply(const Matrix4& m, bool replace, const Text& text, const Place& place) {
    GraphicsState& state = scope_.state;
    Motion moved = state.transform;
    // Most things stand still: then one matrix is the other.
    const bool is_still = state.active_transforms == GraphicsState::both_bits && !moved.is_animated();
    if (state.active_transforms & GraphicsState::start_bit) moved.start = replace ? m : moved.start * m;
    if (is_still)
        moved.end = moved.start;
    else if (state.active_transforms & GraphicsState::end_bit)
        moved.end = replace ? m : moved.end * m;
    if (moved.start.inverse() && (is_still || moved.end.inverse())) {
        state.transform = moved;
        return;
    }
    std::string directive;
    if constexpr (std::is_invocable_v<Text>)
        directive = text();
    else
        directive = text;
    messages_.add_error(place, fmt::format("{} gives a transformation that cannot be inverted", directive));
}

void PbrtBuilder::identity(Place place) {
    apply(Matrix4{}, true, "Identity", place);
}

void PbrtBuilder::translate(Vec3d v, Place place) {
    apply(Matrix4::translate(v), false, "Translate", place);
}

void PbrtBuilder::scale(Vec3d v, Place place) {
    apply(
        Matrix4::scale(v), false, [&] { return fmt::format("Scale {} {} {}", v.x, v.y, v.z); }, place);
}

void PbrtBuilder::rotate(double degrees, Vec3d axis, Place place) {
    if (!(length_squared(axis) > 0)) {
        messages_.add_error(std::move(place),
                            "Rotate about the axis 0 0 0; expected an axis that is not zero");
        return;
    }
    apply(Matrix4::rotate(degrees, axis), false, "Rotate", place);
}

void PbrtBuilder::look_at(Vec3d eye, Vec3d target, Vec3d up, Place place) {
    if (auto view = Matrix4::look_at(eye, target, up))
        apply(*view, false, "LookAt", place);
    else
        messages_.add_error(std::move(place),
                            "LookAt needs an eye apart from its target and an up vector that is not "
                            "along the view");
}

void PbrtBuilder::transform(const std::array<double, 16>& m, Place place) {
    apply(from_columns(m), true, "Transform", place);
}

void PbrtBuilder::concat_transform(const std::array<double, 16>& m, Place place) {
    apply(from_columns(m), false, "ConcatTransform", place);
}

void PbrtBuilder::coordinate_system(const std::string& name, Place) {
    scope_.coordinate_systems[name] = scope_.state.transform;
}

void PbrtBuilder::coord_sys_transform(const std::string& name, Place place) {
    auto found = scope_.coordinate_systems.find(name);
    if (found != scope_.coordinate_systems.end()) {
        scope_.state.transform = found->second;
        return;
    }
    std::vector<std::string> known;
    for (const auto& [other, motion] : scope_.coordinate_systems) known.push_back(other);
    messages_.add_warning(std::move(place),
                          fmt::format("no coordinate system \"{}\"; the transformation stays as it is{}",
                                      printable(name), did_you_mean(name, known)));
}

void PbrtBuilder::active_transform(std::string_view which, Place place) {
    if (which == "All")
        scope_.state.active_transforms = GraphicsState::both_bits;
    else if (which == "StartTime")
        scope_.state.active_transforms = GraphicsState::start_bit;
    else if (which == "EndTime")
        scope_.state.active_transforms = GraphicsState::end_bit;
    else
        messages_.add_error(
            std::move(place),
            fmt::format("ActiveTransform {}; expected All, StartTime or EndTime", printable(which)));
}

void PbrtBuilder::transform_times(double start, double end, Place place) {
    if (!check_options("TransformTimes", place)) return;
    const auto from = static_cast<float>(start), to = static_cast<float>(end);
    if (!(from < to) || !std::isfinite(from) || !std::isfinite(to)) {
        messages_.add_error(
            std::move(place),
            fmt::format("TransformTimes {} {}; expected the start before the end", start, end));
        return;
    }
    scene_.time_start = from;
    scene_.time_end = to;
}

void PbrtBuilder::attribute_begin(std::string directive, Place place) {
    if (!check_world(directive, place)) return;
    if (scope_.open.size() >= deepest_nesting) {
        // Reading on would only say the same of every further block, and of those that are never closed.
        messages_.add_error(place, fmt::format("blocks nested more than {} deep", deepest_nesting));
        messages_.throw_if_errors();
    }
    scope_.open.push_back({OpenBlock::Kind::attribute, std::move(place), std::move(directive), scope_.state});
}

void PbrtBuilder::attribute_end(std::string_view directive, Place place) {
    if (check_world(directive, place)) close_block(OpenBlock::Kind::attribute, directive, place);
}

void PbrtBuilder::close_block(OpenBlock::Kind kind, std::string_view directive, const Place& place) {
    if (scope_.open.empty()) {
        if (kind == OpenBlock::Kind::object && scope_.in_object)
            messages_.add_error(
                place, "ObjectEnd in an imported file; expected it in the file that has the ObjectBegin");
        else
            messages_.add_error(
                place, fmt::format("{} without an {}", directive,
                                   kind == OpenBlock::Kind::object ? "ObjectBegin" : "AttributeBegin"));
        return;
    }
    OpenBlock block = std::move(scope_.open.back());
    scope_.open.pop_back();
    if (block.kind != kind)
        messages_.add_error(place, fmt::format("{} while the {} of {} is open", directive, block.directive,
                                               block.place.text()));
    scope_.state = std::move(block.saved);
    if (block.kind == OpenBlock::Kind::object && object_) {
        scene_.objects.push_back(std::move(*object_));
        object_.reset();
    }
}

void PbrtBuilder::report_open_blocks() {
    for (const OpenBlock& block : scope_.open) {
        std::string end = block.directive.substr(0, block.directive.size() - 5) + "End";
        messages_.add_error(block.place, fmt::format("{} without {}", block.directive, end));
    }
}

void PbrtBuilder::warn_transform_blocks(Place place) {
    if (warned_transform_blocks_) return;
    warned_transform_blocks_ = true;
    messages_.add_warning(std::move(place),
                          "TransformBegin and TransformEnd are deprecated and act as AttributeBegin "
                          "and AttributeEnd: other attributes are restored too");
}

void PbrtBuilder::attribute(Node node, Place place) {
    static const std::vector<std::string> targets{"shape", "light", "material", "medium", "texture"};
    auto found = std::find(targets.begin(), targets.end(), node.type);
    if (found == targets.end()) {
        messages_.add_error(
            std::move(place),
            fmt::format("unknown Attribute target \"{}\"; expected \"shape\", \"light\", \"material\", "
                        "\"medium\" or \"texture\"",
                        printable(node.type)));
        return;
    }
    auto& defaults = scope_.state.defaults[static_cast<std::size_t>(found - targets.begin())];
    Node merged;
    if (defaults) merged.parameters = *defaults;
    for (Parameter& p : node.parameters) {
        p.may_be_unused = true;
        merged.set(std::move(p));
    }
    if (merged.parameters.size() > 1000)
        throw SyntaxError(std::move(place), "more than 1000 Attribute parameters");
    defaults = std::make_shared<const std::vector<Parameter>>(std::move(merged.parameters));
}

void PbrtBuilder::color_space(const std::string& name, Place place) {
    if (const RgbColorSpace* space = find_color_space(name))
        scope_.state.color_space = space;
    else
        messages_.add_error(std::move(place), fmt::format("unknown color space \"{}\"{}", printable(name),
                                                          did_you_mean(name, color_space_names())));
}

void PbrtBuilder::reverse_orientation(Place place) {
    if (check_world("ReverseOrientation", place))
        scope_.state.reverse_orientation = !scope_.state.reverse_orientation;
}

void PbrtBuilder::medium_interface(std::string inside, std::string outside, Place place) {
    scope_.state.inside_medium = {std::move(inside), place};
    scope_.state.outside_medium = {std::move(outside), std::move(place)};
}

ImportScope PbrtBuilder::begin_import() {
    ImportScope importer = std::move(scope_);
    scope_ = {};
    scope_.state = importer.state;
    scope_.coordinate_systems = importer.coordinate_systems;
    scope_.in_object = object_.has_value();
    return importer;
}

void PbrtBuilder::end_import(ImportScope importer) {
    report_open_blocks();
    // An object the import left open would swallow what follows.
    if (!scope_.in_object) object_.reset();
    scope_ = std::move(importer);
}

} // namespace alhazen
