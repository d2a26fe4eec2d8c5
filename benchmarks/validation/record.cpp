#include "benchmarks/validation/record.h"

namespace alhazen::bench {

Json to_json(const ReferenceComparison& c) {
    Json errors = Json::array();
    for (const ErrorAt& e : c.errors) errors.push_back({{"spp", e.spp}, {"relmse", e.relmse}});
    return {{"scene", c.scene},
            {"spp", c.spp},
            {"seeds", c.seeds},
            {"cpu_seconds", c.cpu_seconds},
            {"load_seconds", c.load_seconds},
            {"mean_ratio", c.mean_ratio},
            {"mean_ratio_error", c.mean_ratio_error},
            {"errors", errors},
            {"noise", c.noise},
            {"reference_noise", c.reference_noise},
            {"unexplained", c.unexplained},
            {"mean_z2", c.mean_z2},
            {"beyond_four", c.beyond_four},
            {"block", c.block},
            {"flip", c.flip},
            {"agrees", agrees(c)}};
}

} // namespace alhazen::bench
