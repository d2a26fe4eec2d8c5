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
        float weight; ///< curve / pdf: the integral of the curve's size, with its sign
    };

    FilterCurve() = default;
    template <class Curve>
    FilterCurve(float radius, Curve curve) {
        constexpr int steps = 256;
        std::vector<float> heights;
        for (int i = 0; i < steps; ++i)
            heights.push_back(curve(radius * ((static_cast<float>(i) + 0.5f) / (steps / 2) - 1)));
        build(heights, radius);
    }
    Sample sample(float u) const {
        auto s = table_.sample(u);
        return {s.x, signs_[static_cast<std::size_t>(s.cell)] * table_.integral()};
    }
    float integral() const { return integral_; }

  private:
    void build(const std::vector<float>& heights, float radius);

    PiecewiseConstant1D table_;
    std::vector<float> signs_{1};
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
    void finish(const Node&, BuildContext&) {
        across_ = FilterCurve(xradius, [&](float x) { return self().curve(x, xradius); });
        down_ = FilterCurve(yradius, [&](float y) { return self().curve(y, yradius); });
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
