#pragma once

// A job for the tracer on a device, and the combined results of its pieces.

#include "bake/scene/trace_scene.h"
#include "bake/trace/sample_sequence.h"
#include "bake/trace/tracer.h"
#include "bake/trace/vector_sums.h"
#include "bake/trace_gpu/trace_piece.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct TraceJob {
    const Receivers& receivers;
    std::span<const std::uint32_t> indices;
    const TraceOptions& options;
    bool hits;
    std::span<const SumRow> sum_rows;   ///< [indices] set if vectors are summed on the device
    std::span<const float> sum_weights; ///< [sums]
    SobolChunk whole, last;             ///< all chunks except the last one, and the last chunk
    TracePiece::Room room = {};

    TraceJob(const Receivers& all, std::span<const std::uint32_t> some, const TraceOptions& trace,
             bool with_hits, std::span<const SumRow> rows = {}, std::span<const float> weights = {});

    int stride() const { return hits ? options.hit_stride : 1; }
    std::size_t chunks() const { return (static_cast<std::size_t>(options.rays) + kChunk - 1) / kChunk; }
    /// Returns reversed Sobol points of a whole chunk, then of the last chunk.
    std::vector<glm::uvec2> samples() const;
};

/// Computes transfer from sums over rays, with the unshadowed lobe as control variate (docs/math.md, eq. 9),
/// and collects hits.
class TraceResults {
public:
    /// `vectors`: [indices][order²], or [indices][first_coefficients] if vectors are summed.
    TraceResults(const TraceJob& job, const TraceScene& scene, std::span<float> vectors, const HitSink& sink);

    /// Start of a piece in the job.
    struct Position {
        std::size_t receiver = 0, chunk = 0;
    };
    void add_hits(Position at, const TracePiece& piece, std::span<const gpu::HitRecord> records);
    /// Adds the sums of a piece. After the last chunk of a receiver all its hits are known.
    void add_sums(Position at, const TracePiece& piece, int threads);

private:
    void add(std::size_t i, const gpu::HitRecord& r, float weight);
    void add_followed(Position at, const TracePiece& piece, std::span<const gpu::HitRecord> records);
    void finish(std::size_t i);

    const TraceJob& job_;
    const TraceScene& scene_;
    std::span<float> vectors_;
    std::size_t coefficients_; ///< coefficients of a vector
    const HitSink& sink_;
    std::vector<double> control_; ///< [indices] rays of the chunks that use the control variate
    std::vector<std::vector<Hit>> hits_;
};

} // namespace prt
