/// Colours in parameters, in all their forms.
#include "describe/spectrum_parameter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/file.h"

namespace alhazen {

namespace {

using testing::HasSubstr;

Parameter spectrum_samples(std::vector<float> pairs) {
    return make_array<float>("s", ValueType::spectrum, std::move(pairs));
}

class SpectrumParameterTest : public testing::Test {
  protected:
    std::optional<SpectrumValue> read(const Parameter& p, SpectrumRole role = SpectrumRole::unbounded) {
        BuildContext context{messages};
        context.base_folder = testing::TempDir();
        return read_spectrum(p, role, context);
    }
    // The value at 500, 550, 600 and 650 nm; -1 with an error.
    Spectrum value(const Parameter& p, SpectrumRole role = SpectrumRole::unbounded) {
        auto v = read(p, role);
        return v ? v->eval({ColorMode::spectral, Spectrum(500, 550, 600, 650), 1}) : Spectrum(-1);
    }
    std::string message(const Parameter& p, SpectrumRole role = SpectrumRole::unbounded) {
        EXPECT_FALSE(read(p, role).has_value());
        return messages.list().empty() ? "" : messages.list().back().text;
    }

    Messages messages;
};

TEST_F(SpectrumParameterTest, Numbers) {
    EXPECT_EQ(value(make_float("s", 1.5f)), Spectrum(1.5f));
    EXPECT_EQ(value(make_integer("s", 2)), Spectrum(2));
    EXPECT_TRUE(read(make_float("s", 1.5f))->is_constant());
    EXPECT_THAT(message(make_float("s", -1)), HasSubstr("must not be negative"));
}

TEST_F(SpectrumParameterTest, Rgb) {
    Spectrum green = value(make_rgb("s", 0.1f, 0.8f, 0.1f), SpectrumRole::albedo);
    EXPECT_GT(green[1], green[3]);
    EXPECT_NEAR(value(make_rgb("s", 0.5f, 0.5f, 0.5f), SpectrumRole::albedo)[2], 0.5f, 1e-3f);
    EXPECT_NEAR(value(make_rgb("s", 4, 4, 4))[2], 4, 0.02f);
    EXPECT_THAT(message(make_rgb("s", 0.1f, -0.8f, 0.1f)), HasSubstr("has the component -0.8"));
    EXPECT_THAT(message(make_rgb("s", 0.1f, 1.8f, 0.1f), SpectrumRole::albedo),
                HasSubstr("a reflectance must be 0 to 1"));
    EXPECT_THAT(message(make_array<float>("s", ValueType::rgb, {1, 2})), HasSubstr("must have three values"));
}

TEST_F(SpectrumParameterTest, RgbOfOtherSpaces) {
    Parameter p = make_rgb("s", 0.1f, 0.8f, 0.1f);
    p.color_space = "rec2020";
    EXPECT_TRUE(read(p).has_value());
    p.color_space = "rec202";
    EXPECT_THAT(message(p), HasSubstr("is in the colour space \"rec202\", which is not known (did you mean"));
}

TEST_F(SpectrumParameterTest, Blackbody) {
    Parameter p = make_array<float>("s", ValueType::blackbody, {3000});
    Spectrum v = value(p, SpectrumRole::illuminant);
    EXPECT_LT(v[0], v[3]);
    p = make_array<float>("s", ValueType::blackbody, {0});
    EXPECT_THAT(message(p), HasSubstr("temperature must be above 0"));
    p = make_array<float>("s", ValueType::blackbody, {3000, 1});
    EXPECT_THAT(message(p), HasSubstr("one temperature in kelvin"));
}

TEST_F(SpectrumParameterTest, Samples) {
    Spectrum v = value(spectrum_samples({400, 1, 600, 3}));
    EXPECT_NEAR(v[0], 2, 1e-5f);
    EXPECT_NEAR(v[1], 2.5f, 1e-5f);
    EXPECT_THAT(message(spectrum_samples({400, 1, 600})), HasSubstr("is not a spectrum"));
    EXPECT_THAT(message(spectrum_samples({600, 1, 400, 2})), HasSubstr("is not a spectrum"));
    EXPECT_THAT(message(spectrum_samples({})), HasSubstr("is not a spectrum"));
    EXPECT_THAT(message(spectrum_samples({400, infinity})), HasSubstr("must be a finite number"));
}

TEST_F(SpectrumParameterTest, Names) {
    // Schott BK7 at 587.6 nm: 1.5168.
    Spectrum v = value(make_spectrum("s", "glass-BK7"));
    EXPECT_NEAR(v[2], 1.5163f, 1e-3f);
    EXPECT_THAT(message(make_spectrum("s", "glass-BK8")),
                HasSubstr("is \"glass-BK8\", which is neither a known spectrum nor a file (did you mean"));
}

TEST_F(SpectrumParameterTest, Files) {
    std::string name = "spectrum-" + std::to_string(getpid()) + ".spd";
    std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
    write_file(path, "# nm value\n400 1\n600 3\n");
    EXPECT_NEAR(value(make_spectrum("s", name))[0], 2, 1e-5f);
    write_file(path, "400 one\n");
    EXPECT_THAT(message(make_spectrum("s", name)), HasSubstr("names the spectrum file"));
    std::filesystem::remove(path);
    EXPECT_THAT(message(make_spectrum("s", ".")), HasSubstr("directory"));
}

TEST_F(SpectrumParameterTest, OtherTypesAreErrors) {
    EXPECT_THAT(message(make_string("s", "red")),
                HasSubstr("is declared as string, but must be rgb | spectrum"));
    EXPECT_THAT(message(make_bool("s", true)), HasSubstr("is declared as bool"));
}

} // namespace

} // namespace alhazen
