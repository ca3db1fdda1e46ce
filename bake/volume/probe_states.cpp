#include "volume/probe_states.h"

#include "volume/probe_places.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace prt {
namespace {

using Key = std::tuple<int, int, int, int>;

Key key_of(const glm::ivec3& corner, std::uint8_t level) {
    return {corner.x, corner.y, corner.z, level};
}

/// Distances that are seen from the corner of a probe that was measured `way` off it.
std::array<float, 6> seen_from(std::array<float, 6> distances, const glm::vec3& way) {
    for (int a = 0; a < 3; ++a) {
        float& low = distances[static_cast<std::size_t>(2 * a)];
        float& high = distances[static_cast<std::size_t>(2 * a + 1)];
        low = std::max(low - way[a], 0.02f * low);
        high = std::max(high + way[a], 0.02f * high);
    }
    return distances;
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
    states.blind.resize(probes.size());
    states.moved.resize(probes.size());
    return states;
}

/// Takes over what `before` has; the probes that it has not.
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
        states.blind[p] = before.blind[from];
        states.moved[p] = before.moved[from];
    }
    return missing;
}

} // namespace

std::vector<ProbeSight> ProbeStates::sights(const VolumeGrid& grid) const {
    std::vector<ProbeSight> sights(size(), ProbeSight{});
    for (std::size_t p = 0; p < size(); ++p)
        if (!blind[p])
            sights[p] = sight_of(distances[p], cell_of(grid, levels[p]));
    return sights;
}

ProbeStates measure_probes(const ProbeTask& task, const VolumeGrid& grid, const VolumeProbes& probes,
                           ProbeStates before, const Progress& progress) {
    const IncidentLayout& layout = task.tracer.layout();
    ProbeStates states = unmeasured(probes, layout.coefficients() * layout.numbers());
    const std::vector<std::uint32_t> missing = take_over(before, states);
    before = {};
    std::vector<glm::vec3> corners;
    std::vector<float> cells;
    for (const std::uint32_t p : missing) {
        corners.push_back(position_of(grid, probes.corners[p]));
        cells.push_back(cell_of(grid, probes.levels[p]));
    }
    const std::vector<glm::vec3> places = free_places(task.scene, corners, cells, task.threads);
    const float most = kSightCells * cell_of(grid, kMostBrickLevel);
    task.tracer.trace({places, most, task.rays, task.seed}, progress,
                      [&](std::size_t i, const PlaceSeen& seen) {
                          const std::size_t p = missing[i];
                          std::ranges::copy(seen.vectors, &states.values[p * states.stride]);
                          states.blind[p] = seen.backs > kMostBacks;
                          states.moved[p] = places[i] != corners[i];
                          states.distances[p] = seen_from(seen.distances, places[i] - corners[i]);
                      });
    return states;
}

} // namespace prt
