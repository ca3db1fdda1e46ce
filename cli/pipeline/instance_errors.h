#pragma once

#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/model.h"
#include "cli/report/report.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt::pipeline {

/// Returns lit_rms of each instance of the file, over its vertices. `wanted`, `lit` and `areas` are
/// [receivers]; `scale` [receivers] is the radiance that errors are relative to.
std::vector<double> instance_errors(const InstancedModel& file, const Scene& scene,
                                    std::span<const float> areas, std::span<const glm::vec3> wanted,
                                    std::span<const glm::vec3> lit, std::span<const glm::vec3> scale);

/// Returns a table of percentiles of these errors [lights][instances].
Table instances_table(const std::vector<LoadedLight>& lights, const std::vector<std::vector<double>>& errors);

} // namespace prt::pipeline
