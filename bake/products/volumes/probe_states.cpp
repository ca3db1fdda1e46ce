// Measures new probes, and reuses the measurements of existing ones.

#include "bake/products/volumes/probe_states.h"

#include "bake/products/volumes/probe_positions.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace prt {
namespace {

using Key = std::tuple<int, int, int, int>;

Key key_of(const glm::ivec3& corner, std::uint8_t level) {
    return {corner.x, corner.y, corner.z, level};
}

float cell_of(const VolumeGrid& grid, std::uint8_t level) {
    return grid.spacing * static_cast<float>(1 << level);
}

ProbeStates unmeasured(const VolumeProbes& probes, std::size_t stride) {
    ProbeStates states;
    states.stride = stride;
    states.corners = probes.corners;
    states.levels = probes.levels;
    states.values.resize(probes.size() * stride);
    states.distances.resize(probes.size());
    states.invalid.resize(probes.size());
    states.moved.resize(probes.size());
    return states;
}

/// Copies the probes that `before` has. Returns the missing probes.
std::vector<std::uint32_t> take_over(const ProbeStates& before, ProbeStates& states) {
    std::map<Key, std::size_t> there;
    for (std::size_t p = 0; p < before.size(); ++p)
        there.emplace(key_of(before.corners[p], before.levels[p]), p);
    std::vector<std::uint32_t> missing;
    for (std::uint32_t p = 0; p < states.size(); ++p) {
        const auto found = there.find(key_of(states.corners[p], states.levels[p]));
        if (found == there.end()) {
            missing.push_back(p);
            continue;
        }
        const std::size_t from = found->second;
        std::copy_n(&before.values[from * states.stride], states.stride, &states.values[p * states.stride]);
        states.distances[p] = before.distances[from];
        states.invalid[p] = before.invalid[from];
        states.moved[p] = before.moved[from];
    }
    return missing;
}

} // namespace

std::vector<ProbeVisibility> ProbeStates::visibility(const VolumeGrid& grid) const {
    std::vector<ProbeVisibility> visibility(size(), ProbeVisibility{});
    for (std::size_t p = 0; p < size(); ++p)
        if (!invalid[p])
            visibility[p] = visibility_of(distances[p], cell_of(grid, levels[p]));
    return visibility;
}

ProbeStates measure_probes(const ProbeTask& task, const VolumeGrid& grid, const VolumeProbes& probes,
                           ProbeStates before, const Progress& progress) {
    const IncidentLayout& layout = task.tracer.layout();
    ProbeStates states = unmeasured(probes, layout.coefficients() * layout.numbers());
    const std::vector<std::uint32_t> missing = take_over(before, states);
    before = {};
    std::vector<ProbeCell> cells;
    for (const std::uint32_t p : missing) {
        cells.push_back({position_of(grid, probes.corners[p]), cell_of(grid, probes.levels[p])});
    }
    const std::vector<glm::vec3> positions = free_positions(task.scene, cells, task.threads);
    task.tracer.trace({positions, cells, task.rays, task.seed}, progress,
                      [&](std::size_t i, const ProbeView& seen) {
                          const std::size_t p = missing[i];
                          std::ranges::copy(seen.vectors, &states.values[p * states.stride]);
                          states.invalid[p] = seen.backs > kMaxBackShare;
                          states.moved[p] = positions[i] != cells[i].corner;
                          states.distances[p] = seen.distances;
                      });
    return states;
}

} // namespace prt
