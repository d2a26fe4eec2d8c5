/// Spectra known by name: CIE illuminants, metals and glasses, from the tables in data/.
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "color/spectral.h"

namespace alhazen {

namespace {

constexpr float illuminant_d50[] = {
#include "color/data/illuminant_d50.inl"
};
constexpr float illuminant_d65[] = {
#include "color/data/illuminant_d65.inl"
};
constexpr float illuminant_f1[] = {
#include "color/data/illuminant_f1.inl"
};
constexpr float illuminant_f2[] = {
#include "color/data/illuminant_f2.inl"
};
constexpr float illuminant_f3[] = {
#include "color/data/illuminant_f3.inl"
};
constexpr float illuminant_f4[] = {
#include "color/data/illuminant_f4.inl"
};
constexpr float illuminant_f5[] = {
#include "color/data/illuminant_f5.inl"
};
constexpr float illuminant_f6[] = {
#include "color/data/illuminant_f6.inl"
};
constexpr float illuminant_f7[] = {
#include "color/data/illuminant_f7.inl"
};
constexpr float illuminant_f8[] = {
#include "color/data/illuminant_f8.inl"
};
constexpr float illuminant_f9[] = {
#include "color/data/illuminant_f9.inl"
};
constexpr float illuminant_f10[] = {
#include "color/data/illuminant_f10.inl"
};
constexpr float illuminant_f11[] = {
#include "color/data/illuminant_f11.inl"
};
constexpr float illuminant_f12[] = {
#include "color/data/illuminant_f12.inl"
};
constexpr float metal_ag[] = {
#include "color/data/metal_ag.inl"
};
constexpr float metal_al[] = {
#include "color/data/metal_al.inl"
};
constexpr float metal_au[] = {
#include "color/data/metal_au.inl"
};
constexpr float metal_cu[] = {
#include "color/data/metal_cu.inl"
};
constexpr float metal_cuzn[] = {
#include "color/data/metal_cuzn.inl"
};
constexpr float metal_mgo[] = {
#include "color/data/metal_mgo.inl"
};
constexpr float metal_tio2[] = {
#include "color/data/metal_tio2.inl"
};

using Table = std::map<std::string, SpectralCurve, std::less<>>;

SpectralCurve normalized(const SpectralCurve& curve) {
    return curve.scaled(static_cast<float>(cie_y_integral / y_integral(curve)));
}

/// Samples by 5 nm, kept on to the ends of the range.
SpectralCurve lamp(float first, std::span<const float> values) {
    return normalized(SpectralCurve::uniform(first, 5, {values.begin(), values.end()}).extended());
}

/// CIE 15:2004, equation 3.1: a tungsten lamp, the black body of 2848 K on the scale where c2 = 1.435e-2 m K.
SpectralCurve illuminant_a() {
    auto planck = [](double lambda) { return std::pow(lambda, -5) / std::expm1(1.435e7 / (2848 * lambda)); };
    std::vector<float> values;
    for (double lambda = lambda_min; lambda <= lambda_max; ++lambda)
        values.push_back(static_cast<float>(planck(lambda) / planck(560)));
    return normalized(SpectralCurve::uniform(lambda_min, 1, std::move(values)));
}

void add_metal(Table& table, const std::string& name, std::span<const float> rows) {
    std::vector<float> lambdas, eta, k;
    for (std::size_t i = 0; i < rows.size(); i += 3) {
        lambdas.push_back(rows[i]);
        eta.push_back(rows[i + 1]);
        k.push_back(rows[i + 2]);
    }
    table.emplace("metal-" + name + "-eta", SpectralCurve::from_samples(lambdas, eta).extended());
    table.emplace("metal-" + name + "-k", SpectralCurve::from_samples(lambdas, k).extended());
}

/// Dispersion n^2 = 1 + sum B lambda^2 / (lambda^2 - C), lambda in micrometres (Sellmeier 1871).
struct Sellmeier {
    std::array<double, 3> b, c;
};

SpectralCurve glass(const Sellmeier& s) {
    std::vector<float> values;
    for (double lambda = lambda_min; lambda <= lambda_max; ++lambda) {
        double square = lambda * lambda * 1e-6, n2 = 1;
        for (std::size_t i = 0; i < 3; ++i) n2 += s.b[i] * square / (square - s.c[i]);
        values.push_back(static_cast<float>(std::sqrt(n2)));
    }
    return SpectralCurve::uniform(lambda_min, 1, std::move(values));
}

/// Schott's catalogue of optical glass; all but BK7 are today's "N-" melts, as in pbrt-v4.
void add_glasses(Table& table) {
    auto add = [&](const std::string& name, const Sellmeier& s) { table.emplace("glass-" + name, glass(s)); };
    add("BK7", {{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}});
    add("BAF10", {{1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}});
    add("FK51A", {{0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}});
    add("LASF9", {{2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}});
    const Sellmeier sf5{{1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}};
    const Sellmeier sf10{{1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}};
    const Sellmeier sf11{{1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}};
    // pbrt-v4 calls the flint glasses F; Schott, SF.
    for (const char* prefix : {"F", "SF"}) {
        add(std::string(prefix) + "5", sf5);
        add(std::string(prefix) + "10", sf10);
        add(std::string(prefix) + "11", sf11);
    }
}

void add_illuminants(Table& table) {
    table.emplace("stdillum-A", illuminant_a());
    table.emplace("stdillum-D50", lamp(lambda_min, illuminant_d50));
    table.emplace("stdillum-D65", lamp(lambda_min, illuminant_d65));
    // The white of ACES is daylight of 6000 K (SMPTE ST 2065-1:2012 gives its chromaticity).
    table.emplace("illum-acesD60", SpectralCurve::daylight(6000));
    const std::array<std::span<const float>, 12> fluorescent{
        illuminant_f1, illuminant_f2, illuminant_f3, illuminant_f4,  illuminant_f5,  illuminant_f6,
        illuminant_f7, illuminant_f8, illuminant_f9, illuminant_f10, illuminant_f11, illuminant_f12};
    for (std::size_t i = 0; i < fluorescent.size(); ++i)
        table.emplace("stdillum-F" + std::to_string(i + 1), lamp(380, fluorescent[i]));
}

const Table& table_of_spectra() {
    static const Table table = [] {
        Table t;
        add_illuminants(t);
        add_metal(t, "Ag", metal_ag);
        add_metal(t, "Al", metal_al);
        add_metal(t, "Au", metal_au);
        add_metal(t, "Cu", metal_cu);
        add_metal(t, "CuZn", metal_cuzn);
        add_metal(t, "MgO", metal_mgo);
        add_metal(t, "TiO2", metal_tio2);
        add_glasses(t);
        return t;
    }();
    return table;
}

} // namespace

const SpectralCurve* named_spectrum(std::string_view name) {
    auto found = table_of_spectra().find(name);
    return found == table_of_spectra().end() ? nullptr : &found->second;
}

const std::vector<std::string>& spectrum_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const auto& [name, curve] : table_of_spectra()) list.push_back(name);
        return list;
    }();
    return names;
}

} // namespace alhazen
