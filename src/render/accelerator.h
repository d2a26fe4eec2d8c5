/// What a scene says about acceleration structures: pbrt's Accelerator directive.
#pragma once

#include "accel/accel.h"
#include "describe/kind.h"

namespace alhazen {

struct Accelerator {
    static constexpr std::string_view family_name = "accelerator";
    virtual ~Accelerator() = default;

    AccelChoice choice; ///< set by finish
    std::string builder = AccelChoice{}.builder;
    std::string walk = AccelChoice{}.walk;
    int stackentries = WalkOptions{}.stack_entries;

  protected:
    template <class T>
    static void describe_common(Fields<T>& f) {
        f.field("builder", &T::builder,
                "how the tree is built: " + names_of(accel_builders()) + "; +reinsertion may follow");
        f.field("walk", &T::walk, "how rays walk through it: " + names_of(accel_walks()));
        f.field("stackentries", &T::stackentries, "of the walk with a short stack").in(1, 64);
    }
    /// Checks the names and makes the choice.
    void choose(const Node& node, BuildContext& context);

  private:
    template <class List>
    static std::string names_of(const List& list) {
        std::string text;
        for (const auto& entry : list) text += (text.empty() ? "" : ", ") + std::string(entry.name);
        return text;
    }
};

const KindList<Accelerator>& accelerator_kinds();

} // namespace alhazen
