// Combines the results of the pieces of a job.

#include "bake/trace_gpu/trace_job.h"

#include "bake/device/gpu_failure.h"
#include "bake/scene/opposite_triangles.h"
#include "prt/core/sh.h"
#include "runtime/core/support/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {

TraceJob::TraceJob(const Receivers& all, std::span<const std::uint32_t> some, const TraceOptions& trace,
                   bool with_hits, std::span<const SumRow> rows, std::span<const float> weights)
    : receivers(all), indices(some), options(trace), hits(with_hits), sum_rows(rows), sum_weights(weights),
      whole(kChunk, stride()), last((trace.rays - 1) % kChunk + 1, stride()) {}

std::vector<glm::uvec2> TraceJob::samples() const {
    std::vector<glm::uvec2> table;
    for (const SobolChunk* chunk : {&whole, &last}) {
        for (std::size_t i = 0; i < chunk->x.size(); ++i)
            table.emplace_back(chunk->x[i], chunk->y[i]);
        table.resize(chunk == &whole ? kChunk : 2 * kChunk);
    }
    return table;
}

TraceResults::TraceResults(const TraceJob& job, const TraceScene& scene, std::span<float> vectors,
                           const HitSink& sink)
    : job_(job), scene_(scene), vectors_(vectors), coefficients_(vectors.size() / job.indices.size()),
      sink_(sink), control_(job.sum_rows.empty() ? job.indices.size() : 0, 0.0),
      hits_(sink ? job.indices.size() : 0) {
    std::ranges::fill(vectors, 0.0f);
}

void TraceResults::add_hits(Position at, const TracePiece& piece, std::span<const gpu::HitRecord> records) {
    if (scene_.surfaces().traits().alpha)
        for (const gpu::HitRecord& r : records)
            add(at.receiver + r.row / piece.push().chunks, r, r.weight);
    else
        add_followed(at, piece, records);
}

void TraceResults::add_sums(Position at, const TracePiece& piece, int threads) {
    const gpu::TracePush& push = piece.push();
    const std::size_t numbers = coefficients_ + (control_.empty() ? 0 : 1);
    if (!std::ranges::all_of(piece.sums().first(push.receivers * numbers),
                             [](float v) { return std::isfinite(v); }))
        throw GpuFailure("the GPU returns numbers that are not finite: its driver fails with this scene");
    parallel_for(push.receivers, 64, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float* const sums = &piece.sums()[i * numbers];
            for (std::size_t k = 0; k < coefficients_; ++k)
                vectors_[(at.receiver + i) * coefficients_ + k] += sums[k];
            if (!control_.empty())
                control_[at.receiver + i] += static_cast<double>(sums[coefficients_]);
            if (at.chunk + push.chunks == job_.chunks())
                finish(at.receiver + i);
        }
    });
}

void TraceResults::add(std::size_t i, const gpu::HitRecord& r, float weight) {
    hits_[i].push_back(scene_.rays().opposites().shown(
        {r.triangle & ~PRT_HIT_BACK, r.u, r.v, weight, r.footprint, (r.triangle & PRT_HIT_BACK) != 0}));
}

/// Adds hits of followed rays; the hits of a chunk represent all its blocked rays.
void TraceResults::add_followed(Position at, const TracePiece& piece,
                                std::span<const gpu::HitRecord> records) {
    const std::size_t slots = piece.push().whole_followed + 1;
    for (std::size_t row = 0; row * slots < records.size(); ++row) {
        const std::span<const gpu::HitRecord> slots_of_row = records.subspan(row * slots, slots);
        const std::size_t chunk = at.chunk + row % piece.push().chunks;
        const std::size_t followed = chunk + 1 == job_.chunks() ? piece.push().last_followed : slots - 1;
        const auto there = [](const gpu::HitRecord& r) { return r.triangle != PRT_NO_HIT; };
        const auto found =
            std::ranges::count_if(slots_of_row.first(followed), there) + (there(slots_of_row.back()) ? 1 : 0);
        const float weight = static_cast<float>(piece.blocked_rays()[row]) / static_cast<float>(found);
        for (std::size_t s = 0; s < slots; ++s)
            if ((s < followed || s + 1 == slots) && there(slots_of_row[s]))
                add(at.receiver + row / piece.push().chunks, slots_of_row[s], weight);
    }
}

/// Adds the unshadowed lobe to the difference that the rays measured.
void TraceResults::finish(std::size_t i) {
    if (!control_.empty()) {
        std::array<double, kMaxOrder * kMaxOrder> lobe{};
        clamped_cosine_lobe(job_.options.order, glm::dvec3(job_.receivers.normals[job_.indices[i]]), lobe);
        for (std::size_t k = 0; k < coefficients_; ++k) {
            float& v = vectors_[i * coefficients_ + k];
            v = static_cast<float>((control_[i] * lobe[k] + static_cast<double>(v)) / job_.options.rays);
        }
    }
    if (sink_) {
        sink_(i, hits_[i]);
        hits_[i] = {};
    }
}

} // namespace prt
