/// Textures of textures: how deep and how many.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "describe/nesting.h"
#include "tests/unit/textures/support.h"

namespace alhazen {
namespace {

using ::testing::HasSubstr;

Node named(std::string name, std::vector<Parameter> parameters) {
    Node node;
    node.name = std::move(name);
    node.parameters = std::move(parameters);
    return node;
}

TEST(NestingGuard, CountsDepthAndWhatIsNamedAgain) {
    NestingGuard guard;
    Messages messages;
    EXPECT_TRUE(guard.add(named("t0", {}), ValueType::texture, "textures", messages));
    int i = 1;
    while (guard.add(named(fmt::format("t{}", i), {make_texture("tex", fmt::format("t{}", i - 1))}),
                     ValueType::texture, "textures", messages))
        ++i;
    EXPECT_EQ(i, NestingGuard::max_depth);
    ASSERT_EQ(messages.list().size(), 1u);
    EXPECT_THAT(messages.list()[0].text, HasSubstr("textures are nested deeper than 256"));

    // Twice the one before, each time: 2^n - 1 in all.
    EXPECT_TRUE(guard.add(named("d1", {}), ValueType::texture, "textures", messages));
    for (int n = 2;; ++n) {
        const std::string before = fmt::format("d{}", n - 1);
        const Node node =
            named(fmt::format("d{}", n), {make_texture("tex1", before), make_texture("tex2", before)});
        if (guard.add(node, ValueType::texture, "textures", messages)) continue;
        EXPECT_EQ(n, 20);
        break;
    }
    EXPECT_THAT(messages.list().back().text, HasSubstr("\"d20\" is made of more than 1000000 textures"));
    // Strings are no textures.
    EXPECT_TRUE(
        guard.add(named("file", {make_string("filename", "d19")}), ValueType::texture, "textures", messages));
}

TEST_F(TextureTest, NestedTooDeepAreAnError) {
    std::vector<TextureNode> nodes;
    for (int i = 0; i < 5000; ++i) {
        TextureNode node = texture_node(
            "scale", {i == 0 ? make_float("tex", 1) : make_texture("tex", fmt::format("t{}", i - 1))}, true);
        node.node.name = fmt::format("t{}", i);
        nodes.push_back(std::move(node));
    }
    build(nodes);
    EXPECT_THAT(first_message(), HasSubstr("textures are nested deeper than 256"));
}

} // namespace
} // namespace alhazen
