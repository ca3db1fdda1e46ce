// Computes the errors of instances and their percentiles.

#include "cli/pipeline/instance_errors.h"

#include "cli/pipeline/instance_report.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace prt::pipeline {

std::vector<double> instance_errors(const InstancedModel& file, const Scene& scene,
                                    std::span<const float> areas, std::span<const glm::vec3> wanted,
                                    std::span<const glm::vec3> lit, std::span<const glm::vec3> scale) {
    std::vector<double> errors;
    for (const FileInstance& instance : file.instances) {
        double wrong = 0, all = 0;
        for (const std::size_t array : instance.arrays) {
            const VertexArray& vertices = scene.vertex_arrays[array];
            for (std::size_t r = vertices.first_receiver; r < vertices.first_receiver + vertices.size();
                 ++r) {
                const glm::vec3 off = lit[r] - wanted[r];
                wrong += static_cast<double>(areas[r] * glm::dot(off, off));
                all += static_cast<double>(areas[r] * glm::dot(scale[r], scale[r]));
            }
        }
        errors.push_back(all > 0 ? std::sqrt(wrong / all) : 0);
    }
    return errors;
}

Table instances_table(const std::vector<LoadedLight>& lights,
                      const std::vector<std::vector<double>>& errors) {
    Table table{
        "instances",
        "Errors of instances by light",
        "lit_rms of each instance that shares the transfer of its mesh, over the vertices of the instance, "
        "relative to its radiance under the complete light. Suns are separate if the transfer has a direct "
        "term.",
        {},
        {}};
    const Unit share = Unit::percent;
    table.columns = {{"light", "light"},
                     {"count", "instances"},
                     {"median", "median", share, 2},
                     {"percentile_90", "90th percentile", share, 2},
                     {"percentile_99", "99th percentile", share, 2},
                     {"max", "maximum", share, 2}};
    for (std::size_t l = 0; l < lights.size(); ++l) {
        if (errors[l].empty())
            continue;
        const Json of = percentiles(errors[l]);
        table.rows.push_back({lights[l].name, errors[l].size(), of["median"], of["percentile_90"],
                              of["percentile_99"], of["max"]});
    }
    return table;
}

} // namespace prt::pipeline
