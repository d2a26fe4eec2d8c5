/// Nodes that are built at the same time.
#include "describe/build_apart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/threads.h"

namespace alhazen {
namespace {

TEST(BuildApart, MessagesComeAsIfInTurn) {
    Messages messages;
    messages.lenient = true;
    BuildContext context{messages};
    context.film_diagonal = 3;
    with_threads(4, [&] {
        build_apart(19, context, [](std::size_t i, BuildContext& own) {
            EXPECT_EQ(own.film_diagonal, 3);
            EXPECT_TRUE(own.messages.lenient);
            EXPECT_EQ(own.messages.error_count(), 0u) << "of others";
            if (i % 2 == 0) own.messages.add_error({}, std::to_string(i));
            if (i == 7) own.messages.add_warning({}, "seven");
        });
    });
    EXPECT_EQ(context.film_diagonal, 3);
    std::string all;
    for (const Message& m : messages.list()) all += m.text + " ";
    EXPECT_EQ(all, "0 2 4 6 seven 8 10 12 14 16 18 ");
    EXPECT_EQ(messages.error_count(), 10u);
}

TEST(BuildApart, TooManyErrorsEndItAsInTurn) {
    Messages messages;
    BuildContext context{messages};
    EXPECT_THROW(
        build_apart(100, context,
                    [](std::size_t i, BuildContext& own) { own.messages.add_error({}, std::to_string(i)); }),
        SceneError);
    EXPECT_EQ(messages.error_count(), Messages::max_errors);
    EXPECT_EQ(messages.list().back().text, std::to_string(Messages::max_errors - 1));
}

TEST(BuildApart, TheFirstExceptionComesOut) {
    Messages messages;
    BuildContext context{messages};
    try {
        build_apart(50, context, [](std::size_t i, BuildContext&) {
            if (i >= 20) throw std::runtime_error(std::to_string(i));
        });
        FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
        EXPECT_STREQ(e.what(), "20");
    }
}

} // namespace
} // namespace alhazen
