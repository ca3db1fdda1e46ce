// Converts figures and budgets to JSON.

#include "script/figures_json.h"

namespace viewer {
namespace {

using Json = nlohmann::json;

Json lightmap_json(const LightmapFigures& f) {
    Json maps = Json::array();
    for (const prt::LightmapSize& map : f.maps)
        maps.push_back({map.width, map.height});
    const TransferFigures& t = f.transfer;
    return {{"maps", maps},
            {"texels", f.texels},
            {"receivers", f.receivers},
            {"raw_bytes", t.raw_bytes},
            {"bytes_per_texel", t.bytes_per_receiver},
            {"bytes_per_texel_with_bases", t.bytes_with_bases},
            {"clusters", t.clusters},
            {"order", t.order},
            {"channels", t.channels}};
}

} // namespace

nlohmann::json figures_json(const Figures& f) {
    const Milliseconds& ms = f.milliseconds;
    const TransferFigures& t = f.transfer;
    Json json{{"frame_milliseconds", ms.frame},
              {"longest_frame_milliseconds", ms.longest},
              {"gpu_milliseconds", ms.gpu},
              {"vertex_milliseconds", ms.vertices},
              {"constants_milliseconds", ms.constants},
              {"open_milliseconds", ms.open},
              {"receivers", f.receivers},
              {"triangles", f.triangles},
              {"triangles_drawn", f.triangles_drawn},
              {"raw_bytes", t.raw_bytes},
              {"bytes_per_vertex", t.bytes_per_receiver},
              {"bytes_per_vertex_with_bases", t.bytes_with_bases},
              {"clusters", t.clusters},
              {"order", t.order},
              {"channels", t.channels},
              {"reference_passes", f.reference_passes},
              {"difference_relative_l2", f.difference.relative_l2},
              {"difference_mean_radiance", f.difference.mean},
              {"difference_pixels", f.difference.pixels}};
    if (f.instances)
        json["instances"] = {{"count", f.instances->instances},
                             {"meshes", f.instances->meshes},
                             {"bytes", f.instances->bytes_in_file},
                             {"bytes_of_constants", f.instances->bytes_of_constants},
                             {"bytes_of_radiance", f.instances->bytes_of_radiance},
                             {"milliseconds_to_update", f.instances->milliseconds_to_update}};
    if (f.lightmap)
        json["lightmap"] = lightmap_json(*f.lightmap);
    return json;
}

nlohmann::json budget_json(const prt::ErrorBudget& budget) {
    const auto json = [](const prt::SquaredError& error) {
        return Json{{"error", error.root()},
                    {"squared", error.value},
                    {"squared_low", error.low},
                    {"squared_high", error.high}};
    };
    Json causes = Json::object();
    for (std::size_t i = 0; i < prt::kErrorCauses; ++i)
        causes[prt::to_string(static_cast<prt::ErrorCause>(i))] = json(budget.causes[i]);
    return {{"total", json(budget.total)}, {"causes", causes}, {"squared_together", budget.together.value}};
}

} // namespace viewer
