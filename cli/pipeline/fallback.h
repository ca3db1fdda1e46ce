#pragma once

#include "cli/pipeline/model.h"
#include "cli/report/report.h"
#include "prt/gltf/gltf.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt::pipeline {

/// The light of `prt compress --fallback`, which viewers without PRT show.
struct Fallback {
    Lighting lighting; ///< its name is that of its file
    // Found when it is written.
    float exposure = 1;
    std::size_t primitives = 0; ///< that show it
};

/// Loads the fallback light; empty if `light` is empty. Throws `Error`.
std::optional<Fallback> load_fallback(const Path& light, int order, const LightOptions& options, int threads);

/// `file`, a compressed .glb of vertices, with the fallback.
std::vector<std::byte> with_fallback(std::span<const std::byte> file, const Path& path, Fallback& fallback,
                                     BufferCompression buffers, int threads);

void report_fallback(const std::optional<Fallback>& fallback, Report& report);

} // namespace prt::pipeline
