#include <nlohmann/json.hpp>

#include "lab/json_text.h"
#include "lab/report.h"

namespace alhazen {

namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

Json record(const LabReport& report, const WalkRecord& walk) {
    const BuildRecord& build = report.builds[walk.build];
    Json json;
    json["scene"] = report.scene;
    json["builder"] = build.choice.builder;
    json["walk"] = build.choice.walk;
    json["rays"] = name_of(walk.rays);
    json["query"] = name_of(walk.query);
    json["mode"] = name_of(walk.mode);
    json["threads"] = report.threads;
    json["mrays_per_s"] = walk.mrays_per_s;
    json["spread"] = walk.spread;
    json["embree_ratio"] = or_null(walk.peer_ratio);
    json["embree_mrays_per_s"] = or_null(walk.peer_mrays_per_s);
    json["opponent"] = walk.opponent.empty() ? Json() : Json(walk.opponent);
    json["agreement"] = walk.agreement ? Json(walk.agreement->same) : Json();
    json["ties"] = walk.agreement ? Json(walk.agreement->ties) : Json();
    json["triangles"] = report.triangles;
    json["primitives"] = report.primitives;
    json["build_s"] = build.build_s;
    json["build_spread"] = build.build_spread;
    json["bytes_per_triangle"] = build.bytes_per_triangle;
    json["nodes"] = build.nodes;
    json["depth"] = build.depth;
    json["sah_cost"] = build.sah_cost;
    json["end_point_overlap"] = build.end_point_overlap;
    json["nodes_per_ray"] = walk.nodes_per_ray;
    json["leaves_per_ray"] = walk.leaves_per_ray;
    json["restarts_per_ray"] = walk.restarts_per_ray;
    json["max_stack"] = walk.max_stack;
    json["stack_entries"] = build.choice.walk_options.stack_entries;
    return json;
}

} // namespace

std::string to_json(const LabReport& report) {
    Json list = Json::array();
    for (const WalkRecord& walk : report.walks) list.push_back(record(report, walk));
    return json_text(list);
}

} // namespace alhazen
