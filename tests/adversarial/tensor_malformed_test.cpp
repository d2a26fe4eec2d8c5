/// Files of measured materials that are wrong, each with the message it must give. None may crash, hang or
/// ask for absurd memory.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/support/measured_file.h"

namespace alhazen {
namespace {

using testing_support::bytes_of;
using testing_support::FieldToWrite;
using testing_support::floats_to_write;
using testing_support::MeasuredModel;
using testing_support::tensor_file;

std::string tensor_fault(const std::string& bytes) {
    try {
        MeasuredData data(TensorFile(bytes), ColorMode::spectral);
        return "";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

MeasuredModel small() {
    MeasuredModel model;
    model.thetas = 3;
    model.nodes = 4;
    model.waves = 2;
    return model;
}
/// The small file with one field instead of that of its name.
std::string with(const FieldToWrite& changed) {
    std::vector<FieldToWrite> fields = small().fields();
    for (FieldToWrite& f : fields)
        if (f.name == changed.name) f = changed;
    return tensor_fault(tensor_file(fields));
}

TEST(MalformedTensor, Headers) {
    using namespace std::string_literals;
    EXPECT_EQ(tensor_fault(small().file()), "");
    const std::string expected = "not a tensor file; expected \"tensor_file\"";
    EXPECT_EQ(tensor_fault(""), expected);
    EXPECT_EQ(tensor_fault("tensor_file"), expected);
    EXPECT_EQ(tensor_fault("P6 512 512 255"), expected);
    EXPECT_EQ(tensor_fault("tensor_file\0\2\1\0\0\0\0"s),
              "unknown version 2.1 of tensor files; expected 1.0");
    EXPECT_EQ(tensor_fault("tensor_file\0\1\0\1"s), "the file ends within its header");
    EXPECT_EQ(tensor_fault("tensor_file\0\1\0\xff\xff\xff\xff"s), "the file ends within its header");
    EXPECT_EQ(tensor_fault("tensor_file\0\1\0\0\0\0\0"s), "field \"theta_i\" is missing");
}

std::string one_field(std::uint8_t type, std::uint64_t offset, const std::vector<std::uint64_t>& shape) {
    return std::string("tensor_file\0\1\0", 14) + bytes_of(std::uint32_t{1}) + bytes_of(std::uint16_t{3}) +
           "abc" + bytes_of(static_cast<std::uint16_t>(shape.size())) + bytes_of(type) + bytes_of(offset) +
           bytes_of(shape);
}

TEST(MalformedTensor, Fields) {
    EXPECT_EQ(tensor_fault(one_field(0, 0, {1})), "field \"abc\" has the unknown type 0");
    EXPECT_EQ(tensor_fault(one_field(12, 0, {1})), "field \"abc\" has the unknown type 12");
    EXPECT_EQ(tensor_fault(one_field(1, 1000, {1})), "field \"abc\" goes beyond the end of the file");
    EXPECT_EQ(tensor_fault(one_field(1, ~std::uint64_t{0}, {1})),
              "field \"abc\" goes beyond the end of the file");
    EXPECT_EQ(tensor_fault(one_field(1, 40, {10})), "field \"abc\" goes beyond the end of the file");
    EXPECT_EQ(tensor_fault(one_field(10, 0, {1000})), "field \"abc\" is larger than the file");
    // Products that overflow.
    EXPECT_EQ(tensor_fault(one_field(10, 0, {1ull << 32, 1ull << 32})),
              "field \"abc\" is larger than the file");
    EXPECT_EQ(tensor_fault(one_field(1, 0, {5, 1ull << 63, 1ull << 63})),
              "field \"abc\" is larger than the file");
    std::vector<FieldToWrite> twice = small().fields();
    twice.push_back(twice.back());
    EXPECT_EQ(tensor_fault(tensor_file(twice)), "field \"jacobian\" is there twice");
}

TEST(MalformedTensor, Contents) {
    EXPECT_EQ(with({"theta_i", Tensor::Type::float64, {1}, bytes_of(0.0)}),
              "field \"theta_i\" is of float64, but must be of float32");
    EXPECT_EQ(with(floats_to_write("theta_i", {1, 3}, {0, 1, 2})),
              "field \"theta_i\" has 2 dimensions, but must have 1");
    EXPECT_EQ(with(floats_to_write("theta_i", {0}, {})), "field \"theta_i\" is empty");
    EXPECT_EQ(with(floats_to_write("theta_i", {3}, {0, 1, 1})),
              "field \"theta_i\" must increase, but 1 is followed by 1");
    EXPECT_EQ(with(floats_to_write("theta_i", {3}, {0, infinity, 1})),
              "field \"theta_i\" holds inf; its values must be finite");
    EXPECT_EQ(with(floats_to_write("wavelengths", {2}, {-5, 1})), "field \"wavelengths\" must be above 0 nm");
    EXPECT_EQ(with(floats_to_write("phi_i", {3}, {-1, 0, 1})),
              "field \"phi_i\" goes from -1 to 1; only data of the full circle can be read");
    EXPECT_EQ(with(floats_to_write("ndf", {1, 4}, {0, 1, 2, 3})),
              "field \"ndf\" is 1 x 4, but must be n x m, with n and m at least 2");
    EXPECT_EQ(with(floats_to_write("vndf", {1, 2, 2, 2}, std::vector<float>(8, 1.0f))),
              "field \"vndf\" is 1 x 2 x 2 x 2, but must be 1 x 3 x n x m, with n and m at least 2");
    EXPECT_EQ(
        with(floats_to_write("spectra", {1, 3, 1, 2, 2}, std::vector<float>(12, 1.0f))),
        "field \"spectra\" is 1 x 3 x 1 x 2 x 2, but must be 1 x 3 x 2 x n x m, with n and m at least 2");
    EXPECT_EQ(with(floats_to_write("sigma", {2, 2}, {1, 1, std::nanf(""), 1})),
              "field \"sigma\" holds nan; its values must be finite");
    EXPECT_EQ(with({"jacobian", Tensor::Type::uint8, {2}, std::string(2, '\1')}),
              "field \"jacobian\" must be a single value of uint8");
}

// Whatever the bytes, there is a message or a set of tables.
TEST(MalformedTensor, AnyByteMayBeWrong) {
    const std::string good = small().file();
    Rng rng(1);
    for (int i = 0; i < 3000; ++i) {
        std::string bad = good;
        // Mostly in the header.
        const std::uint32_t at = rng.below(static_cast<std::uint32_t>(i % 4 == 0 ? bad.size() : 350));
        bad[at] = static_cast<char>(rng.below(256));
        tensor_fault(bad);
        tensor_fault(good.substr(0, rng.below(static_cast<std::uint32_t>(good.size()))));
    }
}

} // namespace
} // namespace alhazen
