/// What the samplers on a Sobol' sequence declare alike: how many samples, and how the points are made
/// random.
#pragma once

#include "samplers/sobol_sequence.h"

namespace alhazen {

struct RandomizedSobol : CountedSampler {
    Randomization randomization = Randomization::fastowen;

  protected:
    /// No warning says that the count is no power of two when a scene is read, since it may yet be replaced.
    template <class T>
    static void describe_sobol(Fields<T>& f) {
        describe_count(f, "samples taken in each pixel; a power of two spreads them best");
        f.field("randomization", &T::randomization, "how the points are made random");
        describe_seed(f);
        f.example("none", {make_string("randomization", "none")});
        f.example("permutedigits", {make_string("randomization", "permutedigits")});
        f.example("owen", {make_string("randomization", "owen")});
    }
};

} // namespace alhazen
