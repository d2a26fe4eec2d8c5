/// Reconstruction filters. A sample is placed by drawing from the filter around the pixel's centre and counts
/// for that pixel alone (Ernst, Stamminger and Greiner 2006), so that a pixel has one owner. Where the filter
/// is negative, a draw counts negative.
#pragma once

#include "describe/kind.h"

namespace alhazen {

struct FilterSample {
    Vec2 offset; ///< from the pixel's centre, in pixels
    /// f / pdf / the filter's integral, whose mean over all draws is 1: 1 itself for filters that are nowhere
    /// negative, one of two numbers of either sign for the others.
    float weight = 1;
};

struct Filter {
    static constexpr std::string_view family_name = "filter";
    virtual ~Filter() = default;
    virtual float eval(Vec2 offset) const = 0;
    virtual Vec2 radius() const = 0;
    virtual float integral() const = 0; ///< positive
    virtual FilterSample sample(Vec2 u) const = 0;
};

const KindList<Filter>& filter_kinds();

} // namespace alhazen
