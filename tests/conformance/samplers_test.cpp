// What every sampler promises, checked for each kind and each documented example. Statistical tests use fixed
// seeds; see density_test.h for the rate of false alarms.
#include <cmath>

#include <gtest/gtest.h>

#include "samplers/sampler.h"
#include "tests/support/density_test.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

using testing_support::chi_square_test;
using testing_support::make_member;
using testing_support::p_threshold;

constexpr Vec2i resolution{37, 21};

template <class Visit>
void for_each_sampler(Visit visit, Vec2i size = resolution, int spp = 16, std::uint64_t seed = 1) {
    testing_support::for_each_example(sampler_kinds(),
                                      [&](const std::string& kind, const std::string&, Sampler& s) {
                                          s.prepare(size, spp, seed);
                                          visit(kind, s);
                                      });
}

// Calls visit(stream) for one sample of each pixel of a large image: within a pixel, samples of some kinds
// share their place in the strata, so that counts of all of them would not be independent.
constexpr Vec2i large{112, 90};
template <class Visit>
void for_one_sample_a_pixel(const Sampler& s, Visit visit) {
    for (int y = 0; y < large.y; ++y)
        for (int x = 0; x < large.x; ++x)
            visit(SampleStream(s, {x, y}, static_cast<std::uint32_t>(hash_of(x, y) % 16)));
}

// Calls visit(stream) for every sample of every pixel.
template <class Visit>
void for_each_sample(const Sampler& s, Vec2i size, int spp, Visit visit) {
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            for (int i = 0; i < spp; ++i) visit(SampleStream(s, {x, y}, static_cast<std::uint32_t>(i)));
}

// A count of which cell each pair of numbers falls into.
class Histogram {
  public:
    explicit Histogram(int nx, int ny = 1) : nx_(nx), ny_(ny), counts_(static_cast<std::size_t>(nx * ny)) {}
    void add(float x, float y = 0) {
        auto cell = static_cast<std::size_t>(y * static_cast<float>(ny_)) * static_cast<std::size_t>(nx_) +
                    static_cast<std::size_t>(x * static_cast<float>(nx_));
        counts_.at(cell) += 1;
        total_ += 1;
    }
    double p_value() const {
        std::vector<double> expected(counts_.size(), total_ / static_cast<double>(counts_.size()));
        return chi_square_test(counts_, expected).p_value;
    }
    bool all_are(double count) const {
        return std::all_of(counts_.begin(), counts_.end(), [&](double c) { return c == count; });
    }

  private:
    int nx_, ny_;
    std::vector<double> counts_;
    double total_ = 0;
};

TEST(SamplerConformance, NumbersAreInRangeAndPure) {
    for_each_sampler([](const std::string&, Sampler& s) {
        for (Vec2i pixel : {Vec2i(0, 0), Vec2i(36, 20), Vec2i(5, 7)})
            for (std::uint32_t sample : {0u, 3u, 15u, 16u, 100u}) {
                SampleStream a(s, pixel, sample), b(s, pixel, sample);
                // Other draws between must not matter.
                SampleStream other(s, {1, 1}, 2);
                for (int i = 0; i < 1100; ++i) {
                    std::uint32_t before = a.state().dimension;
                    if (i % 3 == 0) {
                        Vec2 u = a.next2();
                        ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
                        other.next1();
                        ASSERT_EQ(u, b.next2());
                        ASSERT_EQ(a.state().dimension, before + 2);
                    } else {
                        float u = a.next1();
                        ASSERT_TRUE(u >= 0 && u < 1);
                        ASSERT_EQ(u, b.next1());
                        ASSERT_EQ(a.state().dimension, before + 1);
                    }
                }
                Vec2 p = SampleStream(s, pixel, sample).pixel2();
                ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
            }
    });
}

TEST(SamplerConformance, SkippingIsDrawingUnseen) {
    for_each_sampler([](const std::string& kind, Sampler& s) {
        for_each_sample(s, {5, 4}, 3, [&](SampleStream stream) {
            SampleStream other = stream;
            stream.pixel2();
            other.pixel2();
            stream.next1();
            stream.next2();
            stream.next1();
            other.skip(1);
            other.skip(2);
            other.skip(1);
            ASSERT_EQ(stream.next2(), other.next2()) << kind;
            ASSERT_EQ(stream.next1(), other.next1()) << kind;
        });
    });
}

TEST(SamplerConformance, SingleNumbersAreUniform) {
    constexpr int count = 24;
    for_each_sampler(
        [](const std::string&, Sampler& s) {
            std::vector<Histogram> histograms(count, Histogram(64));
            for_one_sample_a_pixel(s, [&](SampleStream stream) {
                stream.pixel2();
                for (Histogram& h : histograms) h.add(stream.next1());
            });
            for (int i = 0; i < count; ++i)
                EXPECT_GT(histograms[static_cast<std::size_t>(i)].p_value(), p_threshold) << i;
        },
        large);
}

TEST(SamplerConformance, PairsAreUniform) {
    constexpr int count = 12;
    for_each_sampler(
        [](const std::string&, Sampler& s) {
            Histogram pixel(16, 16);
            std::vector<Histogram> histograms(count, Histogram(16, 16));
            for_one_sample_a_pixel(s, [&](SampleStream stream) {
                Vec2 p = stream.pixel2();
                pixel.add(p.x, p.y);
                for (Histogram& h : histograms) {
                    Vec2 u = stream.next2();
                    h.add(u.x, u.y);
                }
            });
            EXPECT_GT(pixel.p_value(), p_threshold);
            for (int i = 0; i < count; ++i)
                EXPECT_GT(histograms[static_cast<std::size_t>(i)].p_value(), p_threshold) << i;
        },
        large);
}

TEST(SamplerConformance, DimensionsAreNotTied) {
    // Pairs of dimensions: next to each other, apart, and a pair's number with a single one.
    constexpr std::pair<std::size_t, std::size_t> pairs[] = {{0, 1},  {0, 5},   {2, 3}, {3, 9},
                                                             {1, 15}, {12, 13}, {4, 7}};
    for_each_sampler(
        [&](const std::string&, Sampler& s) {
            std::vector<Histogram> histograms(std::size(pairs), Histogram(8, 8));
            std::vector<double> sums(std::size(pairs));
            double n = 0;
            for_one_sample_a_pixel(s, [&](SampleStream stream) {
                std::vector<float> u;
                Vec2 p = stream.pixel2();
                u.insert(u.end(), {p.x, p.y});
                for (int i = 0; i < 5; ++i) {
                    u.push_back(stream.next1());
                    Vec2 v = stream.next2();
                    u.insert(u.end(), {v.x, v.y});
                }
                for (std::size_t i = 0; i < std::size(pairs); ++i) {
                    auto [a, b] = pairs[i];
                    histograms[i].add(u[a], u[b]);
                    sums[i] += (u[a] - 0.5) * (u[b] - 0.5);
                }
                ++n;
            });
            for (std::size_t i = 0; i < std::size(pairs); ++i) {
                EXPECT_GT(histograms[i].p_value(), p_threshold) << i;
                // Each product has the variance 1 / 144; beyond 5 standard deviations once in 1.7 million.
                EXPECT_LT(std::abs(sums[i]) * 12 / std::sqrt(n), 5) << i;
            }
        },
        large);
}

TEST(SamplerConformance, SamplesBeyondTheCountAreFresh) {
    for_each_sampler([](const std::string&, Sampler& s) {
        Histogram h(8, 8);
        for (int x = 0; x < resolution.x; ++x)
            for (std::uint32_t i = 16; i < 96; ++i) {
                SampleStream stream(s, {x, 3}, i);
                stream.pixel2();
                Vec2 u = stream.next2();
                h.add(u.x, u.y);
                SampleStream first(s, {x, 3}, i % 16);
                first.pixel2();
                ASSERT_FALSE(u == first.next2());
            }
        EXPECT_GT(h.p_value(), p_threshold);
    });
}

TEST(SamplerConformance, TheSeedChangesRandomizedNumbers) {
    testing_support::for_each_example(
        sampler_kinds(), [](const std::string&, const std::string& example, Sampler& s) {
            if (example == "none") return;
            s.prepare(resolution, 16, 1);
            Vec2 a = SampleStream(s, {3, 4}, 5).next2(), p = SampleStream(s, {3, 4}, 5).pixel2();
            s.prepare(resolution, 16, 2);
            EXPECT_FALSE(SampleStream(s, {3, 4}, 5).next2() == a);
            EXPECT_FALSE(SampleStream(s, {3, 4}, 5).pixel2() == p);
        });
}

double smooth(Vec2 u) {
    return std::exp(-static_cast<double>(u.x * u.x + u.y * u.y)) * (1 + static_cast<double>(u.x * u.y));
}
// By the midpoint rule on a fine grid.
double smooth_integral() {
    constexpr int n = 512;
    double sum = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            sum += smooth({(static_cast<float>(x) + .5f) / n, (static_cast<float>(y) + .5f) / n});
    return sum / (n * n);
}

// Root of the mean square error of a pixel's estimate, over seeds.
double error_of(Sampler& s, int spp, bool by_pixel2) {
    const double truth = smooth_integral();
    double sum = 0;
    constexpr int seeds = 12;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        s.prepare({1, 1}, spp, seed);
        double mean = 0;
        for (int i = 0; i < spp; ++i) {
            SampleStream stream(s, {0, 0}, static_cast<std::uint32_t>(i));
            mean += smooth(by_pixel2 ? stream.pixel2() : (stream.pixel2(), stream.next2()));
        }
        sum += (mean / spp - truth) * (mean / spp - truth);
    }
    return std::sqrt(sum / seeds);
}

TEST(SamplerConformance, SpreadSamplesConvergeFasterThanIndependentOnes) {
    auto independent = make_member(sampler_kinds(), "independent", {});
    const double reference = error_of(*independent, 1024, true);
    EXPECT_GT(reference, 1e-3);
    testing_support::for_each_example(sampler_kinds(),
                                      [&](const std::string& kind, const std::string&, Sampler& s) {
                                          if (kind == "independent") return;
                                          EXPECT_LT(error_of(s, 1024, true), reference / 3);
                                          EXPECT_LT(error_of(s, 1024, false), reference / 3);
                                      });
}

// Of 2^k points, one in each rectangle of size 2^-a x 2^-(k - a), for every a: a (0, k, 2)-net.
template <class Draw>
bool is_net(int k, Draw draw) {
    for (int a = 0; a <= k; ++a) {
        Histogram h(1 << a, 1 << (k - a));
        for (int i = 0; i < 1 << k; ++i) {
            Vec2 u = draw(static_cast<std::uint32_t>(i));
            h.add(u.x, u.y);
        }
        if (!h.all_are(1)) return false;
    }
    return true;
}

TEST(SamplerConformance, SobolPairsAreNetsInEachPixel) {
    for (int k : {4, 6, 7})
        for_each_sampler(
            [&](const std::string& kind, Sampler& s) {
                if (kind != "zsobol" && kind != "paddedsobol" && kind != "sobol") return;
                for (Vec2i pixel : {Vec2i(0, 0), Vec2i(13, 4), Vec2i(36, 20)}) {
                    auto stream_of = [&](std::uint32_t i) { return SampleStream(s, pixel, i); };
                    EXPECT_TRUE(is_net(k, [&](std::uint32_t i) { return stream_of(i).pixel2(); }));
                    if (kind == "sobol") continue; // its other pairs are spread over the image, not the pixel
                    for (int skip = 0; skip < 6; ++skip)
                        EXPECT_TRUE(is_net(k, [&](std::uint32_t i) {
                            SampleStream stream = stream_of(i);
                            stream.pixel2();
                            for (int j = 0; j < skip; ++j) stream.next1();
                            return stream.next2();
                        }));
                }
            },
            resolution, 1 << k);
}

TEST(SamplerConformance, SobolDimensionsAreStratifiedOverTheImage) {
    for_each_sampler(
        [](const std::string& kind, Sampler& s) {
            if (kind != "sobol" && kind != "zsobol") return;
            std::vector<Histogram> histograms(20, Histogram(4 * 4 * 16));
            for_each_sample(s, {4, 4}, 16, [&](SampleStream stream) {
                stream.pixel2();
                for (Histogram& h : histograms) h.add(stream.next1());
            });
            for (const Histogram& h : histograms) EXPECT_TRUE(h.all_are(1));
        },
        {4, 4}, 16);
}

TEST(SamplerConformance, StratifiedFillsEachCellOnce) {
    auto s = make_member(sampler_kinds(), "stratified",
                         {make_integer("xsamples", 4), make_integer("ysamples", 3)});
    EXPECT_EQ(s->samples_per_pixel(), 12);
    s->prepare(resolution, 12, 0);
    Histogram pixel(4, 3), single(12), pair(4, 3);
    for (std::uint32_t i = 0; i < 12; ++i) {
        SampleStream stream(*s, {7, 8}, i);
        Vec2 p = stream.pixel2();
        pixel.add(p.x, p.y);
        single.add(stream.next1());
        Vec2 u = stream.next2();
        pair.add(u.x, u.y);
    }
    EXPECT_TRUE(pixel.all_are(1) && single.all_are(1) && pair.all_are(1));
}

TEST(SamplerConformance, ZSobolErrorsOfNeighboursCancel) {
    // A block of 8 x 8 pixels has a run of the sequence to itself: its mean is far better than that of 64
    // pixels whose errors are independent.
    auto s = make_member(sampler_kinds(), "zsobol", {});
    constexpr int size = 64, spp = 4;
    s->prepare({size, size}, spp, 3);
    const double truth = smooth_integral();
    double pixel_variance = 0, block_variance = 0;
    for (int by = 0; by < size; by += 8)
        for (int bx = 0; bx < size; bx += 8) {
            double block = 0;
            for (int i = 0; i < 64; ++i) {
                double mean = 0;
                for (std::uint32_t k = 0; k < spp; ++k) {
                    SampleStream stream(*s, {bx + i % 8, by + i / 8}, k);
                    stream.pixel2();
                    mean += smooth(stream.next2()) / spp;
                }
                pixel_variance += (mean - truth) * (mean - truth);
                block += mean / 64;
            }
            block_variance += (block - truth) * (block - truth);
        }
    pixel_variance /= size * size;
    block_variance /= size * size / 64.0;
    EXPECT_LT(block_variance, 0.1 * pixel_variance / 64);
}

} // namespace
} // namespace alhazen
