/// The sphere x^2 + y^2 + z^2 = r^2, whole or cut by heights and by an angle around the z axis.
/// u runs around the axis, v from zmin to zmax by the angle from the axis; dpdu x dpdv points out of the
/// sphere.

#include <fmt/format.h>

#include "shapes/quadric.h"
#include "shapes/rounding.h"

namespace alhazen {

namespace {

struct Sphere final : QuadricShape<Sphere> {
    float radius = 1;
    std::optional<float> zmin, zmax;

    static void describe(Fields<Sphere>& f);
    void finish(const Node& node, BuildContext& context);

    Bounds3 bounds(std::uint32_t) const override {
        Vec3d lo, hi;
        sector_box(r_, phi_max_, lo, hi);
        lo.z = z_min_;
        hi.z = z_max_;
        return intersection_of(placement.ball_bounds(r_), placement.box_bounds(lo, hi));
    }
    bool intersect(const Ray& ray, std::uint32_t primitive, Intersection& hit) const override {
        if (!ball_) return QuadricShape::intersect(ray, primitive, hit);
        auto t = static_cast<float>(ball_->intersect(BallRay(ray)));
        if (!(t > 0) || !(t < ray.tmax)) return false;
        hit.t = t;
        hit.u = hit.v = 0;
        return true;
    }
    Hit surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const override {
        return ball_ ? ball_surface(ray, primitive, met) : QuadricShape::surface(ray, primitive, met);
    }
    Hit plain_surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const override {
        return ball_ ? ball_plain_surface(ray, primitive, met) : QuadricShape::surface(ray, primitive, met);
    }
    std::optional<Ball> ball() const override { return ball_; }
    std::optional<ShapeSample> sample_from(std::uint32_t primitive, Vec3 reference, Vec2 u) const override;
    float pdf_from(std::uint32_t primitive, Vec3 reference, const Hit& hit, Vec3 wi) const override;

    Roots roots(const ObjectRay& r) const {
        double a = dot(r.d, r.d), h = dot(r.o, r.d);
        Vec3d miss = r.o - r.d * (h / a);
        double r2 = r_ * r_;
        return solve_quadratic(a, h, dot(r.o, r.o) - r2, a * (r2 - dot(miss, miss)));
    }
    Vec3d snap(Vec3d p) const { return p * (r_ / length(p)); }
    bool covers(Vec3d p) const { return is_whole_ || (p.z >= z_min_ && p.z <= z_max_ && in_sector(p)); }
    Vec3d outward(Vec3d p) const { return normalize(p); }
    ObjectTangents tangents(Vec3d p) const {
        // On the axis the angle is arbitrary: just beside it all is defined.
        if (p.x == 0 && p.y == 0) p.x = 1e-6 * r_;
        double across = std::sqrt(p.x * p.x + p.y * p.y), range = theta_max_ - theta_min_;
        // As exact as uv, and a good deal faster than in double precision.
        double phi = azimuth(Vec3(p)),
               theta = std::atan2(static_cast<float>(across), static_cast<float>(p.z));
        return {{static_cast<float>(phi / phi_max_), static_cast<float>((theta - theta_min_) / range)},
                Vec3d{-p.y, p.x, 0} * phi_max_,
                Vec3d{p.z * p.x / across, p.z * p.y / across, -across} * range};
    }
    // Equal steps of height cut a sphere into equal areas (Archimedes).
    Vec3d point_at(Vec2d u) const {
        double z = z_max_ + (z_min_ - z_max_) * u.x, phi = phi_max_ * u.y;
        double across = std::sqrt(std::max(0.0, (r_ - z) * (r_ + z)));
        return {across * std::cos(phi), across * std::sin(phi), z};
    }
    double object_area() const { return phi_max_ * r_ * (z_max_ - z_min_); }
    Vec3d at_parameters(double u, double v) const {
        const double phi = phi_max_ * u, theta = std::lerp(theta_min_, theta_max_, v),
                     across = r_ * std::sin(theta);
        return {across * std::cos(phi), across * std::sin(phi), r_ * std::cos(theta)};
    }
    Arcs arcs() const { return {r_, r_, theta_min_ - theta_max_}; }

  private:
    Hit ball_surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const {
        Hit hit = ball_plain_surface(ray, primitive, met);
        ObjectTangents tangents = this->tangents(placement.to_object_vector(from_centre(ray, met.t)));
        hit.dpdu = Vec3(placement.vector(tangents.dpdu));
        hit.dpdv = Vec3(placement.vector(tangents.dpdv));
        hit.uv = tangents.uv;
        return hit;
    }
    Hit ball_plain_surface(const Ray& ray, std::uint32_t primitive, const Intersection& met) const {
        Vec3d from_centre = this->from_centre(ray, met.t), p = ball_->centre + from_centre;
        Hit hit;
        hit.p = Vec3(p);
        hit.p_error = rounding_error(p, abs(ball_->centre) + abs(from_centre));
        hit.wo = normalize(-ray.d);
        hit.ng = hit.ns = placement.turned(Vec3(from_centre * (1 / ball_->radius)));
        hit.t = met.t;
        hit.time = ray.time;
        hit.primitive = primitive;
        return hit;
    }
    // Of the point where the ray meets the ball: not from the Intersection's t, which is rounded, but by one
    // step of Newton's method from there, which no square root is needed for. Not where the ray grazes the
    // ball.
    Vec3d from_centre(const Ray& ray, float t) const {
        const Vec3d d(ray.d);
        const double r2 = ball_->radius * ball_->radius;
        Vec3d v = Vec3d(ray.o) - ball_->centre + d * static_cast<double>(t);
        const double above = dot(v, v) - r2, slope = dot(v, d);
        if (std::abs(above) * dot(d, d) < 1e-4 * (slope * slope)) {
            v -= d * (above / (2 * slope));
        } else {
            const BallRay exact(ray);
            v = exact.o - ball_->centre + exact.d * ball_->intersect(exact);
        }
        // Onto the ball: 1 / sqrt(1 + e) is 1 - e / 2, since the step has left e below 1e-8.
        const double e = dot(v, v) / r2 - 1;
        return v * (1 - e / 2);
    }

    // Squared distance of the reference from the centre over the radius squared, when the cone of directions
    // towards the sphere is to be sampled; 0 otherwise.
    double cone_distance2(Vec3 reference) const {
        Vec3d o = placement.to_object(reference);
        double d2 = dot(o, o) / (r_ * r_);
        return is_whole_ && d2 > 1 + 1e-6 ? d2 : 0;
    }
    // 1 - cosine of the half angle of that cone.
    static double cone_height(double distance2) {
        double sin2 = 1 / distance2;
        return sin2 / (1 + std::sqrt(1 - sin2));
    }
    // Per steradian of the world, along the unit direction w.
    float cone_density(double distance2, Vec3 w) const {
        double per_object_steradian = 1 / (2 * 3.14159265358979323846 * cone_height(distance2));
        return static_cast<float>(per_object_steradian * placement.solid_angle_ratio(w));
    }

    double r_ = 1, z_min_ = -1, z_max_ = 1, theta_min_ = 0, theta_max_ = 0;
    bool is_whole_ = true;
    std::optional<Ball> ball_; ///< when it is whole, and no ellipsoid in the world
};

void Sphere::describe(Fields<Sphere>& f) {
    f.about("A sphere around the origin; zmin, zmax and phimax leave a part of it.");
    f.field("radius", &Sphere::radius, "radius").above(0);
    f.field("zmin", &Sphere::zmin, "lowest height that is kept").otherwise("-radius");
    f.field("zmax", &Sphere::zmax, "largest height that is kept").otherwise("radius");
    describe_sector(f);
    f.example("ball", {make_float("radius", 1)});
    f.example("dome", {make_float("radius", 2), make_float("zmin", 0.5f)});
    f.example("slice", {make_float("radius", 1), make_float("zmin", -0.5f), make_float("zmax", 0.75f),
                        make_float("phimax", 200)});
}

void Sphere::finish(const Node& node, BuildContext& context) {
    r_ = static_cast<double>(radius);
    z_min_ = std::clamp(static_cast<double>(zmin.value_or(-radius)), -r_, r_);
    z_max_ = std::clamp(static_cast<double>(zmax.value_or(radius)), -r_, r_);
    if (z_min_ > z_max_) std::swap(z_min_, z_max_);
    if (z_min_ == z_max_)
        context.messages.add_error(
            node.place,
            fmt::format("zmin is {} and zmax {}, which leaves nothing of a sphere of radius {}; they must "
                        "be two heights, and one of them within the radius",
                        zmin.value_or(-radius), zmax.value_or(radius), radius));
    theta_min_ = std::acos(z_min_ / r_);
    theta_max_ = std::acos(z_max_ / r_);
    is_whole_ = z_min_ <= -r_ && z_max_ >= r_ && phimax >= 360;
    finish_placement(node, context);
    if (auto scale = placement.uniform_scale(); is_whole_ && scale)
        ball_ = Ball{placement.point(Vec3d{}), r_ * *scale, placement.is_turned()};
}

// From outside, directions uniform in the cone that the sphere fills (Shirley, Wang and Zimmerman 1996). In
// object space it is a cone even where the world sees an ellipsoid.
std::optional<ShapeSample> Sphere::sample_from(std::uint32_t primitive, Vec3 reference, Vec2 u) const {
    double distance2 = cone_distance2(reference);
    if (distance2 == 0) return Shape::sample_from(primitive, reference, u);
    Vec3d o = placement.to_object(reference);
    double h = cone_height(distance2) * static_cast<double>(u.x), sin2 = h * (2 - h);
    double phi = 2 * 3.14159265358979323846 * static_cast<double>(u.y);
    double distance = length(o);
    // The sampled direction, in a frame whose z points to the centre, and the near point along it.
    double t = distance * (1 - h) - std::sqrt(std::max(0.0, r_ * r_ - distance * distance * sin2));
    Vec3d z = o * (-1 / distance);
    Vec3d x = normalize(cross(std::abs(z.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, z)), y = cross(z, x);
    Vec3d w = x * (std::sqrt(sin2) * std::cos(phi)) + y * (std::sqrt(sin2) * std::sin(phi)) + z * (1 - h);
    Vec3 wi(normalize(placement.vector(w)));
    return sample_at(snap(o + w * t), cone_density(distance2, wi));
}

float Sphere::pdf_from(std::uint32_t primitive, Vec3 reference, const Hit& hit, Vec3 wi) const {
    double distance2 = cone_distance2(reference);
    if (distance2 == 0) return Shape::pdf_from(primitive, reference, hit, wi);
    return cone_density(distance2, wi);
}

} // namespace

Kind<Shape> sphere_shape() {
    return make_kind<Shape, Sphere>("sphere");
}

} // namespace alhazen
