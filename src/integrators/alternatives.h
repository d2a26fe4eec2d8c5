/// Multiple importance sampling for paths that are followed from both ends, in two running sums for each end
/// instead of a walk along the whole path for each join (van Antwerpen 2011, "Recursive MIS computation for
/// streaming BDPT on the GPU"; Georgiev 2012, "Implementing vertex connection and merging").
///
/// A path of n vertices may be found with any number of them from the light and the rest from the camera.
/// Moving the join by one vertex replaces the density with which that vertex was found from its own side by
/// the one with which it would be found from the other side. So, seen from the join, all strategies that join
/// nearer to a subpath's own end have, relative to the one at hand, the densities
///
///     P(z) / p(z)  [1 + P(y) / p(y)  [1 + P(x) / p(x)  [1 + ...]]]
///
/// where z is the subpath's latest vertex, y the one before it ..., p are the densities per area from the
/// subpath's own side and P those from the other. Only P(z) and P(y) depend on what is joined to z: on the
/// way there, the rest is kept as two numbers. A join next to a specular vertex is impossible: its 1 is left
/// out.
#pragma once

namespace alhazen {

struct Alternatives {
    double last = 0; ///< 1 / p(z), when z and y can be joined
    double earlier =
        0; ///< what P(z) P(y) is multiplied by, for all the joins before; P(y) per steradian at z

    /// The sum, when z is found from the other side with a density per area and y with one per steradian.
    double relative(double found, double found_before) const {
        return found * (last + found_before * earlier);
    }
    /// With the densities so far per steradian at y: at z, a distance away and seen under a cosine.
    Alternatives at_distance(double distance_squared, double cosine) const {
        return {last * distance_squared / cosine, earlier / cosine};
    }
    /// Beyond z, which is left under a cosine in a direction drawn with a density; back is the density of
    /// going from there to y instead.
    Alternatives beyond(double cosine, double pdf, double back, bool is_specular) const {
        const double here = is_specular ? 0 : last;
        return {is_specular ? 0 : 1 / pdf, cosine / pdf * (here + back * earlier)};
    }
};

} // namespace alhazen
