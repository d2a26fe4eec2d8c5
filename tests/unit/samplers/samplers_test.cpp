// What single kinds of sampler do: parameters, messages, known numbers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "samplers/sampler.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::make_member;
using testing_support::messages_of;

TEST(Samplers, CountsAreAsDeclared) {
    EXPECT_EQ(make_member(sampler_kinds(), "independent", {})->samples_per_pixel(), 4);
    EXPECT_EQ(make_member(sampler_kinds(), "stratified", {})->samples_per_pixel(), 16);
    for (const char* kind : {"halton", "sobol", "paddedsobol", "zsobol", "pmj02bn"}) {
        EXPECT_EQ(make_member(sampler_kinds(), kind, {})->samples_per_pixel(), 16);
        EXPECT_EQ(make_member(sampler_kinds(), kind, {make_integer("pixelsamples", 64)})->samples_per_pixel(),
                  64);
    }
}

TEST(Samplers, PrepareTakesAnyCount) {
    testing_support::for_each_example(
        sampler_kinds(), [](const std::string&, const std::string&, Sampler& s) {
            for (int spp : {1, 2, 3, 7, 12, 100, 1023}) {
                s.prepare({5, 4}, spp, 0);
                EXPECT_EQ(s.samples_per_pixel(), spp);
                Vec2 u = SampleStream(s, {4, 3}, static_cast<std::uint32_t>(spp - 1)).pixel2();
                EXPECT_TRUE(u.x >= 0 && u.x < 1);
            }
        });
}

TEST(Samplers, LargeFilmsAndCountsStayInRange) {
    testing_support::for_each_example(
        sampler_kinds(), [](const std::string&, const std::string&, Sampler& s) {
            s.prepare({65536, 65536}, 1 << 20, 0);
            for (Vec2i pixel : {Vec2i(65535, 65535), Vec2i(0, 65535), Vec2i(12345, 1)}) {
                SampleStream stream(s, pixel, (1u << 20) - 1);
                for (Vec2 u : {stream.pixel2(), stream.next2(), stream.next2()})
                    EXPECT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
            }
        });
}

// The scene's count may be replaced, so the advice is in the reference and not in a warning.
TEST(Samplers, AnyCountIsTakenWithoutAWarning) {
    for (const char* kind : {"sobol", "paddedsobol", "zsobol", "halton", "pmj02bn"})
        EXPECT_THAT(messages_of(sampler_kinds(), kind, {make_integer("pixelsamples", 100)}), IsEmpty());
}

TEST(Samplers, BadParametersAreErrors) {
    EXPECT_THAT(messages_of(sampler_kinds(), "halton", {make_string("randomization", "fastowen")}),
                ElementsAre(HasSubstr("\"fastowen\"")));
    EXPECT_THAT(messages_of(sampler_kinds(), "zsobol", {make_integer("pixelsamples", 0)}),
                ElementsAre(HasSubstr("0")));
    EXPECT_THAT(messages_of(sampler_kinds(), "stratified", {make_integer("xsamples", -4)}),
                ElementsAre(HasSubstr("-4")));
    EXPECT_THAT(messages_of(sampler_kinds(), "pmj02bn", {make_integer("pixelsamples", 65537)}),
                ElementsAre(HasSubstr("65537")));
    EXPECT_THAT(messages_of(sampler_kinds(), "zsobl", {}), ElementsAre(HasSubstr("zsobol")));
}

TEST(Halton, MirrorsTheDigits) {
    auto s = make_member(sampler_kinds(), "halton", {make_string("randomization", "none")});
    s->prepare({1, 1}, 16, 0);
    auto stream = [&](std::uint32_t i) { return SampleStream(*s, {0, 0}, i); };
    EXPECT_NEAR(stream(6).pixel2().x, 0.375f, 1e-7f);              // 6 = 110 in base 2, 0.011
    EXPECT_NEAR(stream(5).pixel2().y, 2 / 3.0f + 1 / 9.0f, 1e-7f); // 5 = 12 in base 3, 0.21
    SampleStream seventh = stream(7);
    EXPECT_NEAR(seventh.next1(), 2 / 5.0f + 1 / 25.0f, 1e-7f); // base 5
    EXPECT_NEAR(seventh.next1(), 1 / 49.0f, 1e-7f);            // base 7
}

// Every pixel of a tile gets the points of the sequence that fall into it, none twice.
TEST(Halton, PixelsDivideTheSequence) {
    auto s = make_member(sampler_kinds(), "halton", {make_string("randomization", "none")});
    s->prepare({8, 9}, 1, 0);
    std::vector<int> seen(72);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 8; ++x) seen.at(SampleStream(*s, {x, y}, 0).state().index) += 1;
    EXPECT_THAT(seen, testing::Each(1));
    // Index 1 is at (1/2, 1/3) of the film: pixel (4, 3).
    EXPECT_EQ(SampleStream(*s, {4, 3}, 0).state().index, 1u);
}

TEST(Sobol, PixelsDivideTheSequence) {
    auto s = make_member(sampler_kinds(), "sobol", {make_string("randomization", "none")});
    s->prepare({8, 8}, 4, 0);
    std::vector<int> seen(256);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            for (std::uint32_t i = 0; i < 4; ++i) seen.at(SampleStream(*s, {x, y}, i).state().index) += 1;
    EXPECT_THAT(seen, testing::Each(1));
    // Index 2 is at (1/4, 3/4) of the film: the corner of pixel (2, 6).
    EXPECT_EQ(SampleStream(*s, {2, 6}, 0).state().index, 2u);
    EXPECT_EQ(SampleStream(*s, {2, 6}, 0).pixel2(), Vec2(0, 0));
}

TEST(Stratified, WithoutJitterIsTheCellsCentres) {
    auto s =
        make_member(sampler_kinds(), "stratified",
                    {make_integer("xsamples", 2), make_integer("ysamples", 1), make_bool("jitter", false)});
    s->prepare({4, 4}, 2, 0);
    float sum = 0;
    for (std::uint32_t i = 0; i < 2; ++i) {
        Vec2 u = SampleStream(*s, {1, 1}, i).next2();
        EXPECT_EQ(u.y, 0.5f);
        EXPECT_TRUE(u.x == 0.25f || u.x == 0.75f);
        sum += u.x;
    }
    EXPECT_EQ(sum, 1);
}

} // namespace
} // namespace alhazen
