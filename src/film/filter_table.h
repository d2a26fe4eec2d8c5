/// Filters that are a product of one curve across and one down, drawn from by table.
#pragma once

#include <vector>

#include "film/filter.h"
#include "math/distribution.h"

namespace alhazen {

/// A filter's curve along one axis over [-radius, radius], as steps fine enough to pass for the curve. Where
/// the curve is negative a draw counts negative.
class FilterCurve {
  public:
    struct Sample {
        float x;
        float weight; ///< curve / pdf / integral(): its mean is 1
    };

    FilterCurve() = default;
    template <class Curve>
    FilterCurve(float radius, Curve curve) {
        constexpr int steps = 256;
        std::vector<float> heights;
        for (int i = 0; i < steps; ++i)
            heights.push_back(curve(radius * ((static_cast<float>(i) + 0.5f) / (0.5f * steps) - 1)));
        build(heights, radius);
    }
    Sample sample(float u) const {
        auto s = table_.sample(u);
        return {s.x, weights_[static_cast<std::size_t>(s.cell)]};
    }
    float integral() const { return integral_; }
    /// Whether the curve has an integral to speak of: its positive parts are not cancelled by the negative.
    bool is_positive() const { return integral_ > 1e-3f * table_.integral(); }

  private:
    void build(const std::vector<float>& heights, float radius);

    PiecewiseConstant1D table_;
    std::vector<float> weights_{1};
    float integral_ = 1;
};

/// A product of two curves of one kind. D derives from it, has curve(float x, float radius) const, and calls
/// make_tables() from finish().
template <class D>
struct SeparableFilter : Filter {
    float xradius, yradius;

    explicit SeparableFilter(float default_radius) : xradius(default_radius), yradius(default_radius) {}

    float eval(Vec2 p) const override {
        if (std::abs(p.x) > xradius || std::abs(p.y) > yradius) return 0;
        return self().curve(p.x, xradius) * self().curve(p.y, yradius);
    }
    Vec2 radius() const override { return {xradius, yradius}; }
    float integral() const override { return across_.integral() * down_.integral(); }
    FilterSample sample(Vec2 u) const override {
        auto x = across_.sample(u.x);
        auto y = down_.sample(u.y);
        return {{x.x, y.x}, x.weight * y.weight};
    }
    void finish(const Node& node, BuildContext& context) {
        across_ = FilterCurve(xradius, [&](float x) { return self().curve(x, xradius); });
        down_ = FilterCurve(yradius, [&](float y) { return self().curve(y, yradius); });
        if (!across_.is_positive() || !down_.is_positive())
            context.messages.add_error(
                node.place,
                "the integral of filter \"" + node.type +
                    "\", taken in steps of 1/128 of the radius, is not positive; expected a filter that "
                    "lets more through than it takes away");
    }

  protected:
    template <class T>
    static void describe_radius(Fields<T>& f) {
        f.field("xradius", &T::xradius, "beyond this the filter is 0, across").in(1e-3, 64).unit("pixels");
        f.field("yradius", &T::yradius, "beyond this the filter is 0, down").in(1e-3, 64).unit("pixels");
    }

  private:
    const D& self() const { return static_cast<const D&>(*this); }
    FilterCurve across_, down_;
};

} // namespace alhazen
