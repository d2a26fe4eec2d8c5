/// Files of measured materials made by formula: what a goniophotometer would find of microfacets of
/// Trowbridge and Reitz with a reflectance that rises evenly with the wavelength.
#pragma once

#include <string>
#include <vector>

#include "base/file.h"
#include "materials/fresnel.h"
#include "materials/measured_data.h"
#include "materials/microfacet.h"

namespace alhazen::testing_support {

/// A field before it is written.
struct FieldToWrite {
    std::string name;
    Tensor::Type type = Tensor::Type::float32;
    std::vector<std::uint64_t> shape;
    std::string bytes;
};

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}
template <class T>
std::string bytes_of(T value) {
    return bytes_of(std::vector<T>{value});
}

inline std::string tensor_file(const std::vector<FieldToWrite>& fields) {
    std::size_t header_size = 12 + 2 + 4;
    for (const FieldToWrite& f : fields) header_size += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
    std::string header =
        std::string("tensor_file\0\1\0", 14) + bytes_of(static_cast<std::uint32_t>(fields.size()));
    std::string data;
    for (const FieldToWrite& f : fields) {
        header += bytes_of(static_cast<std::uint16_t>(f.name.size())) + f.name +
                  bytes_of(static_cast<std::uint16_t>(f.shape.size())) +
                  bytes_of(static_cast<std::uint8_t>(f.type)) +
                  bytes_of(static_cast<std::uint64_t>(header_size + data.size())) + bytes_of(f.shape);
        data += f.bytes;
    }
    return header + data;
}

inline FieldToWrite floats_to_write(std::string name, std::vector<std::uint64_t> shape,
                                    const std::vector<float>& values) {
    return {std::move(name), Tensor::Type::float32, std::move(shape), bytes_of(values)};
}

/// The model, and how finely it is measured.
struct MeasuredModel {
    TrowbridgeReitz facets{0.4f, 0.4f};
    float blue = 0.3f, red = 0.8f; ///< reflectance at 400 and at 700 nm
    std::size_t thetas = 8, phis = 1, nodes = 32, waves = 4;
    bool has_facet_factor = true;

    float reflectance(float lambda) const { return lerp((lambda - 400) / 300, blue, red); }
    /// The BSDF times the cosine of wi, both directions above the surface, but for the reflectance.
    float reflected(Vec3 wo, Vec3 wi) const {
        const Vec3 wm = normalize(wo + wi);
        return facets.density(wm) * facets.visible(wo, wi) / (4 * wo.z);
    }

    std::vector<float> axis(std::size_t n, float lo, float hi) const {
        if (n == 1) return {lo};
        std::vector<float> values;
        for (std::size_t i = 0; i < n; ++i)
            values.push_back(lerp(static_cast<float>(i) / static_cast<float>(n - 1), lo, hi));
        return values;
    }
    /// Calls visit for each node of a square, row by row.
    template <class Visit>
    void for_each_node(Visit visit) const {
        for (std::size_t y = 0; y < nodes; ++y)
            for (std::size_t x = 0; x < nodes; ++x)
                visit(Vec2(static_cast<float>(x), static_cast<float>(y)) / static_cast<float>(nodes - 1));
    }
    /// Projected area of the facets per area of the surface, seen from w.
    float area(Vec3 w) const {
        return std::max(w.z, 1e-3f) / facets.visible({w.x, w.y, std::max(w.z, 1e-3f)});
    }

    std::vector<FieldToWrite> fields() const;
    std::string file() const { return tensor_file(fields()); }
};

inline std::vector<FieldToWrite> MeasuredModel::fields() const {
    const std::vector<float> theta = axis(thetas, 0, pi / 2 - 0.02f),
                             phi = axis(phis, phis == 1 ? 0 : -pi, pi), lambda = axis(waves, 400, 700);
    std::vector<float> ndf, sigma, vndf, luminance, spectra;
    for_each_node([&](Vec2 u) {
        const Vec3 w = MeasuredData::from_square(u);
        ndf.push_back(facets.density(w));
        sigma.push_back(area(w));
    });
    for (float p : phi)
        for (float t : theta) {
            const Vec3 wo{std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
            const float turned = phis <= 2 ? p : 0;
            std::vector<float> seen, left;
            for_each_node([&](Vec2 u) {
                const Vec3 wm = MeasuredData::from_square(u, turned);
                seen.push_back(facets.density(wm) * std::max(dot(wo, wm), 0.0f) *
                               MeasuredData::solid_angle(u));
            });
            const BilinearDensities map(seen, nodes, nodes);
            const TableBlend only = blend_around({}, {}, 1);
            for_each_node([&](Vec2 u) {
                const Vec3 wm = MeasuredData::from_square(map.sample(u, only).p, turned);
                Vec3 wi = reflect(wo, wm);
                wi.z = std::max(wi.z, 1e-4f);
                wi = normalize(wi);
                const float f = reflected(wo, wi),
                            factor = facets.density(normalize(wo + wi)) / (4 * area(wo));
                left.push_back(has_facet_factor ? f / factor : f);
                luminance.push_back(f / factor);
            });
            vndf.insert(vndf.end(), seen.begin(), seen.end());
            for (float l : lambda)
                for (float v : left) spectra.push_back(v * reflectance(l));
        }
    const std::string text = "made by formula";
    return {{"description", Tensor::Type::uint8, {text.size()}, text},
            floats_to_write("theta_i", {thetas}, theta),
            floats_to_write("phi_i", {phis}, phi),
            floats_to_write("wavelengths", {waves}, lambda),
            floats_to_write("ndf", {nodes, nodes}, ndf),
            floats_to_write("sigma", {nodes, nodes}, sigma),
            floats_to_write("vndf", {phis, thetas, nodes, nodes}, vndf),
            floats_to_write("luminance", {phis, thetas, nodes, nodes}, luminance),
            floats_to_write("spectra", {phis, thetas, waves, nodes, nodes}, spectra),
            {"jacobian", Tensor::Type::uint8, {1}, std::string(1, has_facet_factor ? '\1' : '\0')}};
}

/// The files that the material's documented examples name, under a folder.
inline void write_measured_examples(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "measured");
    MeasuredModel satin;
    write_file(folder / "measured/satin.bsdf", satin.file());
    MeasuredModel brushed;
    brushed.facets = {0.25f, 0.6f};
    brushed.phis = 17;
    write_file(folder / "measured/brushed.bsdf", brushed.file());
}

} // namespace alhazen::testing_support
