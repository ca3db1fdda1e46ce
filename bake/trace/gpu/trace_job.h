#pragma once

// What a tracer of the device is asked, and what its pieces give, put together.

#include "prt/trace_scene.h"
#include "prt/tracer.h"
#include "trace/gpu/trace_piece.h"
#include "trace/sample_sequence.h"
#include "trace/vector_sums.h"

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
    std::span<const SumRow> sum_rows;   ///< [indices] where vectors are summed on the device
    std::span<const float> sum_weights; ///< [sums]
    SobolChunk whole, last;             ///< all chunks but the last, and the last
    TracePiece::Room room = {};

    TraceJob(const Receivers& all, std::span<const std::uint32_t> some, const TraceOptions& trace,
             bool with_hits, std::span<const SumRow> rows = {}, std::span<const float> weights = {});

    int stride() const { return hits ? options.hit_stride : 1; }
    std::size_t chunks() const { return (static_cast<std::size_t>(options.rays) + kChunk - 1) / kChunk; }
    /// Reversed Sobol points of a whole chunk, then of the last.
    std::vector<glm::uvec2> samples() const;
};

/// Makes transfer of sums over rays, with the open lobe as control variate (docs/math.md, eq. 9), and hits of
/// what is noted.
class TraceResults {
public:
    /// `vectors`: [indices][order²], or [indices][first_coefficients] where vectors are summed.
    TraceResults(const TraceJob& job, const TraceScene& scene, std::span<float> vectors, const HitSink& sink);

    /// Where in the job a piece begins.
    struct Place {
        std::size_t receiver = 0, chunk = 0;
    };
    void add_hits(Place at, const TracePiece& piece, std::span<const gpu::HitRecord> records);
    /// The sums of a piece; after its last chunk a receiver's hits are all there.
    void add_sums(Place at, const TracePiece& piece, int threads);

private:
    void add(std::size_t i, const gpu::HitRecord& r, float weight);
    void add_followed(Place at, const TracePiece& piece, std::span<const gpu::HitRecord> records);
    void finish(std::size_t i);

    const TraceJob& job_;
    const TraceScene& scene_;
    std::span<float> vectors_;
    std::size_t coefficients_; ///< of a vector
    const HitSink& sink_;
    std::vector<double> control_; ///< [indices] rays of the chunks that use the control variate
    std::vector<std::vector<Hit>> hits_;
};

} // namespace prt
