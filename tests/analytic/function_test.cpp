/// Samplers tried on functions whose integral is known.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "integrators/square_function.h"
#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

constexpr auto functions = EnumNames<SquareFunction>::names;

// A grid of a prime number of points on each side: edges along the axes cost at most one row, 1 / 3001 of the
// mean, and others less.
TEST(SquareFunctions, HaveTheIntegralOne) {
    constexpr int n = 3001;
    for (std::size_t f = 0; f < functions.size(); ++f) {
        double sum = 0;
        for (int i = 0; i < n * n; ++i)
            sum += value_at(static_cast<SquareFunction>(f), (i % n + 0.5) / n, (i / n + 0.5) / n);
        EXPECT_NEAR(sum / n / n, 1, 1.0 / n + 1e-9) << functions[f];
    }
}

Rendered integrate(const std::string& function, const std::string& sampler, int spp, int side = 48,
                   const std::string& more = "") {
    RenderSettings settings;
    settings.spp = spp;
    return render_text(fmt::format(R"(Film "rgb" "integer xresolution" {} "integer yresolution" {}
Integrator "function" "string function" "{}" {}
Sampler "{}"
WorldBegin)",
                                   side, side, function, more, sampler),
                       settings);
}

const std::vector<QuadratureError> no_errors;
const std::vector<QuadratureError>& errors_of(const Rendered& rendered) {
    return rendered.stats.quadrature ? rendered.stats.quadrature->errors : no_errors;
}

/// The power of the number of samples with which the error has fallen since the first that has an entry from
/// `from` on.
double fall(const std::vector<QuadratureError>& errors, int from) {
    const auto first =
        std::find_if(errors.begin(), errors.end(), [&](const auto& e) { return e.samples >= from; });
    const QuadratureError& last = errors.back();
    return std::log(first->mean_squared_error / last.mean_squared_error) /
           std::log(static_cast<double>(last.samples) / first->samples);
}

// Mean squares over 2304 pixels are off by 1 / sqrt(1152) on average, 3 %. From 16 samples to 256 that is
// 0.015 of the exponent.
TEST(FunctionIntegrator, ErrorsOfIndependentSamplesAreTheVariance) {
    for (const char* function : {"step", "disk", "checkerboard"}) {
        const Rendered r = integrate(function, "independent", 256);
        const double variance = std::string(function) == "disk" ? 4 / 3.14159265 - 1 : 1;
        ASSERT_EQ(errors_of(r).size(), 9u);
        for (const QuadratureError& e : errors_of(r))
            EXPECT_NEAR(e.mean_squared_error * e.samples / variance, 1, 0.2) << function << e.samples;
        EXPECT_NEAR(fall(errors_of(r), 16), 1, 0.1);
    }
}

// Where the square's cells are few of which an edge cuts, errors fall with the power 3/2, and faster where
// the function is smooth.
TEST(FunctionIntegrator, WellSpreadSamplesDoBetter) {
    for (const char* sampler : {"stratified", "halton", "sobol", "paddedsobol", "zsobol", "pmj02bn"})
        for (const char* function : {"diagonal", "disk", "gaussian"}) {
            SCOPED_TRACE(fmt::format("{} {}", sampler, function));
            const Rendered r = integrate(function, sampler, 256);
            ASSERT_GE(errors_of(r).size(), 4u);
            EXPECT_GT(fall(errors_of(r), 16), 1.2);
            EXPECT_LT(errors_of(r).back().mean_squared_error, 0.5 / errors_of(r).back().samples);
            EXPECT_NEAR(mean_of(r.image, 0), 1, 0.01);
        }
}

TEST(FunctionIntegrator, TheFilmShowsTheEstimates) {
    for (const char* sampler : {"stratified", "zsobol"}) {
        const Rendered r = integrate("disk", sampler, 16, 8);
        double sum = 0;
        for (int i = 0; i < 64; ++i) {
            const Vec3 c = r.image.rgb(i % 8, i / 8);
            EXPECT_NEAR(c.x, c.y, 1e-5f);
            sum += std::pow(static_cast<double>(c.y) - 1, 2);
        }
        EXPECT_NEAR(sum / 64, errors_of(r).back().mean_squared_error, 1e-5);
    }
}

TEST(FunctionIntegrator, KnowsTheFunctionsAndShowsThem) {
    for (const std::string_view function : functions) {
        const Rendered r =
            integrate(std::string(function), "zsobol", 1, 20, R"("string imagefilename" "function.png")");
        ASSERT_TRUE(r.stats.quadrature);
        const Image& image = r.stats.quadrature->integrand;
        ASSERT_EQ(image.size(), Vec2i(20, 20));
        EXPECT_NEAR(mean_of(image, 0), 1, 0.02) << function;
        if (function == "step" || function == "diagonal") {
            EXPECT_EQ(image.at(0, 3), 2) << function;
            EXPECT_EQ(image.at(19, 3), 0) << function;
        }
    }
}

TEST(FunctionIntegrator, TellsAllNumbersOrTheGoodOnes) {
    auto counts = [](const std::string& sampler, const char* skip) {
        std::vector<int> list;
        const Rendered r = integrate("step", sampler, 16, 4, skip);
        for (const auto& e : errors_of(r)) list.push_back(e.samples);
        return list;
    };
    EXPECT_EQ(counts("sobol", ""), (std::vector{1, 2, 4, 8, 16}));
    EXPECT_EQ(counts("stratified", ""), (std::vector{1, 4, 9, 16}));
    EXPECT_EQ(counts("halton", ""), (std::vector{1, 6}));
    EXPECT_EQ(counts("halton", "\"bool skipbad\" false").size(), 16u);
    EXPECT_EQ(counts("stratified", "\"bool skipbad\" false").size(), 16u);
}

TEST(FunctionIntegrator, SaysWhatIsWrong) {
    auto message = [](const std::string& function, const std::string& more) -> std::string {
        try {
            integrate(function, "zsobol", 1, 4, more);
        } catch (const SceneError& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_NE(message("stepp", "").find("\"step\""), std::string::npos);
    EXPECT_NE(message("step", R"("string imagefilename" "f.txt")").find("no kind of picture"),
              std::string::npos);
}

} // namespace
} // namespace alhazen::testing
