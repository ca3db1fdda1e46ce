#pragma once

// Measured probes. Probes that also exist in a finer grid are not measured again.

#include "bake/products/volumes/probe_fit.h"
#include "bake/products/volumes/probe_tracer.h"
#include "bake/scene/trace_scene.h"
#include "prt/core/transfer_volume.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// A position is inside geometry if more of its rays end at dark back faces.
inline constexpr float kMaxBackShare = 0.25f;

struct ProbeStates {
    std::size_t stride = 0;
    std::vector<glm::ivec3> corners;             ///< [probes] see VolumeProbes
    std::vector<std::uint8_t> levels;            ///< [probes]
    std::vector<float> values;                   ///< [probes][stride]
    std::vector<std::array<float, 6>> distances; ///< [probes] visibility distances from the corner, metres
    std::vector<char> invalid, moved;            ///< [probes]

    std::size_t size() const { return corners.size(); }
    ProbeVectors vectors() { return {values, stride}; }
    std::vector<ProbeVisibility> visibility(const VolumeGrid& grid) const;
    std::vector<bool> invalid_mask() const { return {invalid.begin(), invalid.end()}; }
};

struct ProbeTask {
    const TraceScene& scene;
    ProbeTracer& tracer;
    int rays = 1024;
    std::uint64_t seed = 0;
    int threads = 0;
};

/// Returns the states of the probes of `grid`: copies of `before` at the same corners and levels, others
/// measured.
ProbeStates measure_probes(const ProbeTask& task, const VolumeGrid& grid, const VolumeProbes& probes,
                           ProbeStates before, const Progress& progress);

} // namespace prt
