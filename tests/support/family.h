/// Making members of a family in tests: from their kind's name and parameters, and all that the registry
/// documents.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "describe/kind.h"

namespace alhazen::testing_support {

/// A member as a scene would make it; a failed test when there are messages that are errors.
template <class Family>
std::unique_ptr<Family> make_member(const KindList<Family>& kinds, std::string type,
                                    std::vector<Parameter> parameters,
                                    const std::function<void(BuildContext&)>& prepare = {}) {
    Messages messages;
    BuildContext context{messages};
    if (prepare) prepare(context);
    Node node;
    node.type = std::move(type);
    node.parameters = std::move(parameters);
    auto member = kinds.make(node, context, "");
    for (const Message& m : messages.list()) EXPECT_NE(m.kind, Message::Kind::error) << m.text;
    return member;
}

/// The messages' texts that making the member gives.
template <class Family>
std::vector<std::string> messages_of(const KindList<Family>& kinds, std::string type,
                                     std::vector<Parameter> parameters) {
    Messages messages;
    BuildContext context{messages};
    Node node;
    node.type = std::move(type);
    node.parameters = std::move(parameters);
    kinds.make(node, context, "");
    std::vector<std::string> texts;
    for (const Message& m : messages.list()) texts.push_back(m.text);
    return texts;
}

/// Each kind with its defaults, unless it asks for something, and with each of its documented examples.
template <class Family, class Visit>
void for_each_example(const KindList<Family>& kinds, Visit visit,
                      const std::function<void(BuildContext&)>& prepare = {}) {
    for (const Kind<Family>& kind : kinds.all()) {
        const KindDoc doc = kind.doc();
        std::vector<Example> examples = doc.examples;
        const bool needs_something = std::any_of(doc.fields.begin(), doc.fields.end(),
                                                 [](const FieldDoc& field) { return field.is_required; });
        if (!needs_something) examples.insert(examples.begin(), Example{"defaults", {}});
        for (const Example& example : examples) {
            SCOPED_TRACE(std::string(Family::family_name) + " " + kind.name + ", " + example.name);
            auto member = make_member(kinds, kind.name, example.parameters, prepare);
            ASSERT_NE(member, nullptr);
            visit(kind.name, example.name, *member);
        }
    }
}

} // namespace alhazen::testing_support
