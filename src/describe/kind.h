/// A family's kinds: which there are, what each is documented as, and how one is made from a node.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "describe/fields.h"

namespace alhazen {

/// One kind of a family: "diffuse" among the materials.
template <class Family>
struct Kind {
    std::string name;
    std::function<KindDoc()> doc;
    std::function<std::unique_ptr<Family>(const Node&, BuildContext&)> make;
    /// Whether a parameter of that name is declared, and can be read without an error.
    std::function<bool(const Parameter&, const BuildContext&)> reads;
};

/// What a member of a family is called in messages: "material", "shape".
template <class Family>
concept NamedFamily = requires {
    { Family::family_name } -> std::convertible_to<std::string_view>;
};

/// The kind of T, which derives from Family, is default constructible, and has
///     static void describe(Fields<T>&);
/// and, where values must be checked together or prepared, also
///     void finish(const Node&, BuildContext&);     run once all the fields are read without an error
template <class Family, class T>
Kind<Family> make_kind(std::string name) {
    Kind<Family> kind;
    kind.name = name;
    kind.doc = [name] { return fields_of<T>().doc(name); };
    kind.make = [name](const Node& node, BuildContext& context) -> std::unique_ptr<Family> {
        auto object = std::make_unique<T>();
        std::string owner = std::string(Family::family_name) + " \"" + name + "\"";
        std::size_t errors = context.messages.error_count();
        read_fields(*object, node, owner, context);
        if (context.messages.error_count() != errors) return nullptr;
        if constexpr (requires { object->finish(node, context); }) {
            object->finish(node, context);
            if (context.messages.error_count() != errors) return nullptr;
        }
        return object;
    };
    kind.reads = [](const Parameter& parameter, const BuildContext& context) {
        Messages found;
        BuildContext trial{found,
                           context.color_mode,
                           context.base_folder,
                           context.textures,
                           context.materials,
                           context.texture_use};
        trial.sdfs = context.sdfs;
        T object;
        return read_field(object, parameter, trial) && found.error_count() == 0;
    };
    return kind;
}

/// All the kinds of a family, in the order of its list.h.
template <NamedFamily Family>
class KindList {
  public:
    KindList(std::initializer_list<Kind<Family>> kinds) : kinds_(kinds) {}

    const std::vector<Kind<Family>>& all() const { return kinds_; }
    const Kind<Family>* find(std::string_view name) const {
        auto it = std::find_if(kinds_.begin(), kinds_.end(), [&](const auto& k) { return k.name == name; });
        return it == kinds_.end() ? nullptr : &*it;
    }
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const auto& k : kinds_) names.push_back(k.name);
        return names;
    }
    /// The node's object, or nullptr with an error added. In lenient mode an unknown type is replaced by
    /// substitute, if that is not empty, with those of the node's parameters that it can read.
    std::unique_ptr<Family> make(const Node& node, BuildContext& context, std::string_view substitute) const {
        if (const Kind<Family>* kind = find(node.type)) return kind->make(node, context);
        const Kind<Family>* other = substitute.empty() ? nullptr : find(substitute);
        Substitution substitution;
        if (other)
            substitution = substitute_node(node, substitute,
                                           [&](const Parameter& p) { return other->reads(p, context); });
        report_unknown_kind(node, Family::family_name, names(), substitution, context);
        if (!context.messages.lenient || !other) return nullptr;
        return other->make(substitution.node, context);
    }

  private:
    std::vector<Kind<Family>> kinds_;
};

} // namespace alhazen
