/// A clear coat over a matte base, without chance. What reaches the base forgets where it came from, so all
/// that counts of the coat is how much of a direction's light it lets in, and how much of the base's light it
/// sends back. With ein(w) the first, k the second and N reflections at the base, the base adds to the BSDF
///     reflectance / pi * ein(wo) * ein(wi) / eta^2 * (1 + k reflectance + ... + (k reflectance)^(N - 1)),
/// the series of Kubelka and Munk's kind that "plastic" materials have had since Saunderson 1942, here with
/// the coat's roughness and absorption, as the mean of what random walks find.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "materials/dielectric_bsdf.h"

namespace alhazen {

/// The coat of one material: its index and thickness are the same everywhere, its roughness may differ.
class Coat {
  public:
    Coat() = default;
    /// thickness: in mean free paths of a layer that absorbs only. alpha: of the microfacets; none when it
    /// varies, between 0 and 1.
    Coat(float eta, float thickness, std::optional<float> alpha);

    static constexpr float largest_alpha = 1;

    /// The coat at one place; refers to its Coat, which must stay where it is.
    struct Place {
        const Coat* coat = nullptr;
        const float* smoother = nullptr; ///< two rows of let_in's table; none where the border is smooth
        const float* rougher = nullptr;
        float t = 0;         ///< between the two
        float sent_back = 0; ///< fraction of the base's light that comes back to it
        float let_out = 0;   ///< fraction of it that gets out

        /// Fraction of the light along a direction that reaches the base; cosine: with the normal, > 0.
        float let_in(float cosine) const;
    };
    /// alpha at most largest_alpha.
    Place at(float alpha) const;

  private:
    static constexpr int cosines = 64, alphas = 16;
    struct Row {
        float alpha = 0;
        std::array<float, cosines> let_in{};
        float sent_back = 0, let_out = 0;
    };
    Row make_row(float alpha) const;
    Place between(const Row& a, const Row& b, float t) const;
    float let_in_smooth(float cosine) const;
    float through(Vec3 w) const { return std::exp(-thickness_ / std::abs(w.z)); }

    float eta_ = 1, thickness_ = 0;
    std::vector<Row> rows_; ///< of alpha = (i / alphas)^2; or of the only alpha
};

} // namespace alhazen
