/// Textures built from nodes, for tests.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "image/codec.h"
#include "textures/texture_set.h"

namespace alhazen {

/// What textures' colours are asked for.
inline const Wavelengths rgb = Wavelengths::rgb();
inline const Wavelengths some = Wavelengths::sample_visible(0.3f);

inline TextureNode texture_node(std::string type, std::vector<Parameter> parameters, bool is_spectrum,
                                std::string name = "t") {
    TextureNode t;
    t.node.type = std::move(type);
    t.node.name = std::move(name);
    t.node.parameters = std::move(parameters);
    t.is_spectrum = is_spectrum;
    return t;
}

inline TexturePoint at_uv(float u, float v) {
    return {Vec3(0), Vec3(0, 0, 1), Vec2(u, v)};
}
inline TexturePoint at_point(Vec3 p) {
    return {p, Vec3(0, 0, 1), Vec2(0, 0)};
}

class TextureTest : public testing::Test {
  protected:
    void TearDown() override {
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }

    void build(std::vector<TextureNode> nodes, ColorMode mode = ColorMode::spectral) {
        BuildContext context{messages, mode};
        context.base_folder = folder();
        textures.build(nodes, context);
    }
    float number(std::string type, std::vector<Parameter> parameters, const TexturePoint& at) {
        build({texture_node(std::move(type), std::move(parameters), false)});
        auto node = textures.find_float("t");
        return node ? node->eval(at) : -1;
    }
    Spectrum color(const TexturePoint& at, const Wavelengths& lambda,
                   SpectrumRole role = SpectrumRole::albedo, const std::string& name = "t") {
        auto node = textures.find_spectrum(name, role, &messages);
        return node ? node->eval(at, lambda) : Spectrum(-1);
    }
    std::string first_message() const {
        auto list = messages.list();
        return list.empty() ? "" : list[0].text;
    }

    /// A new folder, removed afterwards.
    std::filesystem::path folder() {
        if (folder_.empty()) {
            std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
            folder_ = std::filesystem::path(testing::TempDir()) /
                      ("alhazen-textures-" + name + "-" + std::to_string(getpid()));
            std::filesystem::create_directories(folder_);
        }
        return folder_;
    }
    void save(const std::string& name, const Image& image, Transfer transfer = Transfer::srgb) {
        WriteOptions options;
        options.transfer = transfer;
        options.depth = FloatDepth::single;
        write_image(folder() / name, image, options);
    }
    /// Upper row red, green; lower row blue, white.
    static Image four_colors() {
        Image image = Image::rgb_image(2, 2);
        image.set_rgb(0, 0, {1, 0, 0});
        image.set_rgb(1, 0, {0, 1, 0});
        image.set_rgb(0, 1, {0, 0, 1});
        image.set_rgb(1, 1, {1, 1, 1});
        return image;
    }

    Messages messages;
    TextureSet textures;

  private:
    std::filesystem::path folder_;
};

} // namespace alhazen
