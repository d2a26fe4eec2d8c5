// The camera around a lens: which way up, how wide, how bright, and what is wrong.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "cameras/camera.h"
#include "image/codec.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Parameter lens = make_string("lensfile", "lenses/double-gauss-50mm.txt");
constexpr Vec2i resolution{360, 240};

void prepare(BuildContext& context) {
    context.base_folder = ALHAZEN_SOURCE_DIR "/scenes";
    context.film_resolution = resolution;
    context.film_diagonal = 0.0432666f; // 36 mm x 24 mm
}
std::unique_ptr<Camera> make(std::vector<Parameter> parameters) {
    parameters.push_back(lens);
    return testing_support::make_member(camera_kinds(), "realistic", std::move(parameters), prepare);
}
std::vector<std::string> messages(std::vector<Parameter> parameters) {
    Messages found;
    BuildContext context{found};
    prepare(context);
    Node node;
    node.type = "realistic";
    node.parameters = std::move(parameters);
    camera_kinds().make(node, context, "");
    std::vector<std::string> texts;
    for (const Message& m : found.list()) texts.push_back(m.text);
    return texts;
}

struct Beam {
    Vec3 direction; ///< mean
    float exposure; ///< mean weight
};
Beam beam(const Camera& camera, Vec2 film) {
    Rng rng(3);
    Beam b{};
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const auto r = camera.ray({film, {rng.uniform(), rng.uniform()}, 0});
        if (!r) continue;
        b.direction += r->ray.d * r->weight[0];
        b.exposure += r->weight[0] / n;
    }
    b.direction = normalize(b.direction);
    return b;
}

TEST(Realistic, SeesUprightAndAsWideAsItsFocalLengthSays) {
    auto camera = make({make_float("focusdistance", 1000), make_float("aperturediameter", 3)});
    EXPECT_TRUE(camera->has_lens());
    EXPECT_FALSE(camera->receives_light());
    EXPECT_FALSE(camera->projection());
    const Vec3 centre = beam(*camera, {180, 120}).direction;
    EXPECT_NEAR(centre.x, 0, 1e-4f);
    EXPECT_NEAR(centre.y, 0, 1e-4f);
    // 50 mm, and half of 36 mm: the lens' distortion is less than two hundredths.
    const Vec3 left = beam(*camera, {0, 120}).direction, upper = beam(*camera, {180, 0}).direction;
    EXPECT_NEAR(left.x / left.z, -18 / 50.0f, 0.0072f);
    EXPECT_NEAR(left.y, 0, 1e-3f);
    EXPECT_NEAR(upper.y / upper.z, 12 / 50.0f, 0.0048f);
    EXPECT_NEAR(upper.x, 0, 1e-3f);
}

TEST(Realistic, ExposureGoesWithTheOpeningsAreaAndNotWithItsShape) {
    auto exposure = [](std::vector<Parameter> parameters) {
        return beam(*make(std::move(parameters)), {180, 120}).exposure;
    };
    const float eight = exposure({make_float("aperturediameter", 8)});
    EXPECT_NEAR(exposure({make_float("aperturediameter", 4)}) / eight, 0.25f, 0.01f);
    for (float small : {0.5f, 0.05f})
        EXPECT_NEAR(exposure({make_float("aperturediameter", small)}) / eight / sqr(small / 8), 1, 0.03f)
            << small;
    for (const char* shape : {"gaussian", "square", "pentagon", "star"})
        EXPECT_NEAR(exposure({make_float("aperturediameter", 8), make_string("aperture", shape)}) / eight, 1,
                    0.03f);
    // A picture of the hole is the hole.
    Image hole = Image::grey_image(64, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) hole.at(x, y) = std::hypot(x - 31.5, y - 31.5) < 32 ? 0.5f : 0;
    const std::string file = testing::TempDir() + "hole.pfm";
    write_image(file, hole);
    EXPECT_NEAR(exposure({make_float("aperturediameter", 8), make_string("aperture", file)}) / eight, 1,
                0.03f);
    std::filesystem::remove(file);
}

TEST(Realistic, CornersAreDarker) {
    auto camera = make({make_float("aperturediameter", 17.1f)});
    const float middle = beam(*camera, {180, 120}).exposure, corner = beam(*camera, {1, 1}).exposure;
    // At least by the fourth power of the cosine.
    EXPECT_LT(corner, 0.75f * middle);
    EXPECT_GT(corner, 0.1f * middle);
}

TEST(Realistic, SaysWhatIsWrong) {
    EXPECT_THAT(messages({}), ElementsAre(HasSubstr("lensfile")));
    EXPECT_THAT(messages({make_string("lensfile", "lenses/none.txt")}),
                ElementsAre(HasSubstr("lens file \"lenses/none.txt\": no such file")));
    EXPECT_THAT(messages({make_string("lensfile", "lantern.pbrt")}),
                ElementsAre(HasSubstr("lens file \"lantern.pbrt\": line 2: \"Film\" is not a number")));
    EXPECT_THAT(messages({lens, make_float("focusdistance", 0.1f)}),
                ElementsAre(HasSubstr("cannot be focused at 0.1")));
    EXPECT_THAT(messages({lens, make_float("aperturediameter", 20)}),
                ElementsAre(HasSubstr("the aperture's diameter cannot be 20 mm; the lens opens to 17.1 mm")));
    EXPECT_THAT(messages({lens, make_float("aperturediameter", 17.1f)}), IsEmpty());
    EXPECT_THAT(messages({lens, make_string("aperture", "heart.png")}),
                ElementsAre(HasSubstr(
                    "aperture \"heart.png\" is not circular, gaussian, square, pentagon or star, nor "
                    "an image: no such file")));
    const std::string file = testing::TempDir() + "no-stop.txt";
    std::ofstream(file) << "50 4 1.5 20\n-50 40 1 20\n";
    EXPECT_THAT(messages({make_string("lensfile", file)}), IsEmpty());
    EXPECT_THAT(messages({make_string("lensfile", file), make_string("aperture", "star")}),
                ElementsAre(HasSubstr("has no aperture stop")));
    std::filesystem::remove(file);
}

} // namespace
} // namespace alhazen
