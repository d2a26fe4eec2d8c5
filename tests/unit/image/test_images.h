/// Images that several tests of this room share, made of small integers so that any language makes the same.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "image/image.h"

/// The expression throws a std::runtime_error whose text holds `text`.
#define EXPECT_ERROR(expression, text)                                                                       \
    EXPECT_THAT(std::function<void()>([&] { (void)(expression); }),                                          \
                testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr(text)))

namespace alhazen {

/// f(x, y, c) on every channel of an R, G, B image.
template <class F>
Image rgb_of(int width, int height, F f) {
    Image image = Image::rgb_image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(f(x, y, c));
    return image;
}

/// Red grows to the right, green downwards, blue both; 0 ... 1.
inline Image gradient(int width, int height) {
    return rgb_of(width, height, [=](int x, int y, int c) {
        double u = x / double(width - 1), v = y / double(height - 1);
        return c == 0 ? u : c == 1 ? v : (x + y) / double(width + height - 2);
    });
}

/// Sixty-four levels in no visible order.
inline Image noise(int width, int height) {
    return rgb_of(width, height, [](int x, int y, int c) {
        return ((x * 7 + y * 13 + c * 31 + (x * x * 3 + y * y * 5 + x * y) % 17) % 64) / 63.0;
    });
}

/// A folder of its own for each test, removed afterwards.
class TemporaryFolder : public testing::Test {
  protected:
    TemporaryFolder() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ =
            std::filesystem::temp_directory_path() / (std::string("alhazen-") + test->test_suite_name() +
                                                      "-" + test->name() + "-" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~TemporaryFolder() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    std::filesystem::path file(const std::string& name) const { return folder_ / name; }

  private:
    std::filesystem::path folder_;
};

} // namespace alhazen
