/// Parameters that several kinds of medium have, each declared once.
#pragma once

#include "describe/fields.h"
#include "describe/spectrum_parameter.h"

namespace alhazen {

/// What a density of 1 does to light.
struct CrossSections {
    UnboundedSpectrum sigma_a{1}, sigma_s{1};

  protected:
    template <class T>
    static void describe_cross_sections(Fields<T>& f) {
        f.field("sigma_a", &T::sigma_a, "how much light is absorbed per length where the density is 1")
            .at_least(0);
        f.field("sigma_s", &T::sigma_s, "how much light is scattered per length where the density is 1")
            .at_least(0);
    }
};

/// How numbers of a grid become kelvins.
struct TemperatureFields {
    float temperaturescale = 1;
    std::optional<float> temperatureoffset, temperaturecutoff;

    float kelvin(float number) const {
        return (number - temperatureoffset.value_or(temperaturecutoff.value_or(0))) * temperaturescale;
    }

  protected:
    template <class T>
    static void describe_temperatures(Fields<T>& f) {
        f.field("temperaturescale", &T::temperaturescale, "factor on the temperatures");
        f.field("temperatureoffset", &T::temperatureoffset, "subtracted from the temperatures before scaling")
            .otherwise("temperaturecutoff, or 0");
        f.field("temperaturecutoff", &T::temperaturecutoff, "older name of temperatureoffset");
    }
};

/// How many cells a box has along its sides.
struct GridSides {
    int nx = 1, ny = 1, nz = 1;

    Vec3i sides() const { return {nx, ny, nz}; }
    std::int64_t cell_count() const { return std::int64_t{nx} * ny * nz; }

  protected:
    template <class T>
    static void describe_sides(Fields<T>& f) {
        f.field("nx", &T::nx, "cells along x").in(1, 65536);
        f.field("ny", &T::ny, "cells along y").in(1, 65536);
        f.field("nz", &T::nz, "cells along z").in(1, 65536);
    }
};

} // namespace alhazen
