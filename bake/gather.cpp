#include "gather.h"

#include "prt/parallel.h"
#include "prt/sh_basis.h"
#include "prt/vector_lanes.h"

#include <algorithm>
#include <bit>

namespace prt {
namespace {

/// Sums weights by source: an open hash table that keeps its space between rows. One per thread.
class RowSums {
public:
    void begin(std::size_t most_entries) {
        const std::size_t size = std::bit_ceil(2 * most_entries + 16);
        if (slots_.size() < size)
            slots_.assign(size, {kNoReceiver, 0});
        mask_ = slots_.size() - 1;
        sources_.clear();
        weights_.clear();
    }

    void add(std::uint32_t source, const glm::vec3& weight) {
        if (source == kNoReceiver || weight == glm::vec3(0))
            return;
        std::size_t i = (source * 0x9e3779b1u) & mask_;
        while (slots_[i].source != kNoReceiver && slots_[i].source != source)
            i = (i + 1) & mask_;
        if (slots_[i].source == kNoReceiver) {
            slots_[i] = {source, static_cast<std::uint32_t>(sources_.size())};
            used_.push_back(i);
            sources_.push_back(source);
            weights_.push_back(weight);
        } else {
            weights_[slots_[i].entry] += weight;
        }
    }

    GatherOperator::Row finish(int channels) {
        for (const std::size_t i : used_)
            slots_[i].source = kNoReceiver;
        used_.clear();
        GatherOperator::Row row;
        row.count = static_cast<std::uint32_t>(sources_.size());
        row.sources = std::make_unique_for_overwrite<std::uint32_t[]>(sources_.size());
        row.weights =
            std::make_unique_for_overwrite<float[]>(sources_.size() * static_cast<std::size_t>(channels));
        std::copy(sources_.begin(), sources_.end(), row.sources.get());
        float* to = row.weights.get();
        for (const glm::vec3& weight : weights_)
            for (int c = 0; c < channels; ++c)
                *to++ = weight[c];
        return row;
    }

private:
    struct Slot {
        std::uint32_t source, entry;
    };
    std::vector<Slot> slots_;
    std::size_t mask_ = 0;
    std::vector<std::size_t> used_;
    std::vector<std::uint32_t> sources_;
    std::vector<glm::vec3> weights_;
};

/// A row times the matrix: sums stay in registers.
template <int Order, int Channels>
[[gnu::always_inline]] inline void apply_row(const GatherOperator::Row& row, const float* from, float* to) {
    constexpr int kCoefficients = coefficient_count(Order), kStride = Channels * kCoefficients;
    float sums[kStride] = {};
    for (std::uint32_t e = 0; e < row.count; ++e) {
        const float* source = from + static_cast<std::size_t>(row.sources[e]) * kStride;
        for (int c = 0; c < Channels; ++c) {
            const float weight = row.weights[static_cast<std::size_t>(e) * Channels + static_cast<std::size_t>(c)];
            for (int k = 0; k < kCoefficients; ++k)
                sums[c * kCoefficients + k] += weight * source[c * kCoefficients + k];
        }
    }
    std::copy_n(sums, kStride, to);
}

template <int Channels>
[[gnu::always_inline]] inline void apply_rows(int order, const GatherOperator& gather, std::size_t begin,
                                              std::size_t end, const float* from, float* to) {
    const auto stride = static_cast<std::size_t>(Channels * coefficient_count(order));
    for (std::size_t p = begin; p < end; ++p) {
        const GatherOperator::Row& row = gather.row(p);
        float* const target = to + p * stride;
        switch (order) {
        case 1:
            apply_row<1, Channels>(row, from, target);
            break;
        case 2:
            apply_row<2, Channels>(row, from, target);
            break;
        case 3:
            apply_row<3, Channels>(row, from, target);
            break;
        case 4:
            apply_row<4, Channels>(row, from, target);
            break;
        case 5:
            apply_row<5, Channels>(row, from, target);
            break;
        case 6:
            apply_row<6, Channels>(row, from, target);
            break;
        case 7:
            apply_row<7, Channels>(row, from, target);
            break;
        case 8:
            apply_row<8, Channels>(row, from, target);
            break;
        case 9:
            apply_row<9, Channels>(row, from, target);
            break;
        default:
            apply_row<10, Channels>(row, from, target);
        }
    }
}

PRT_TARGET_CLONES
void apply_block(int order, const GatherOperator& gather, std::size_t begin, std::size_t end, const float* from,
                 float* to) {
    if (gather.channels() == 1)
        apply_rows<1>(order, gather, begin, end, from, to);
    else
        apply_rows<3>(order, gather, begin, end, from, to);
}

} // namespace

std::uint32_t TransportReceivers::back_of(std::uint32_t front) const {
    return back.empty() ? kNoReceiver : back[front];
}

TransportReceivers transport_receivers(Receivers fronts, const Surfaces& surfaces) {
    TransportReceivers result{std::move(fronts), {}, 0};
    result.fronts = result.receivers.size();
    Receivers& all = result.receivers;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        if (!surfaces.two_sided(t))
            continue;
        if (result.back.empty())
            result.back.assign(result.fronts, kNoReceiver);
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t front = surfaces.corners(t)[corner];
            if (result.back[front] != kNoReceiver)
                continue;
            result.back[front] = static_cast<std::uint32_t>(all.size());
            all.positions.push_back(all.positions[front]);
            all.normals.push_back(-all.normals[front]);
            all.areas.push_back(all.areas[front]);
        }
    }
    return result;
}

void GatherOperator::set_row(std::uint32_t receiver, std::span<const Hit> hits, int rays,
                             const Surfaces& surfaces, const TransportReceivers& receivers) {
    thread_local RowSums sums;
    sums.begin(6 * hits.size());
    for (const Hit& hit : hits) {
        if (hit.back && !surfaces.two_sided(hit.triangle))
            continue; // the inside of a solid: it blocks, and no light comes from there
        const Scattering s = surfaces.scattering({hit.triangle, {hit.u, hit.v}, hit.footprint});
        const glm::uvec3& corners = surfaces.corners(hit.triangle);
        const glm::vec3 barycentrics(1 - hit.u - hit.v, hit.u, hit.v);
        const float share = hit.weight / static_cast<float>(rays);
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t front = corners[corner];
            const std::uint32_t back = receivers.back_of(front);
            const float weight = share * barycentrics[corner];
            sums.add(hit.back ? back : front, weight * s.reflected);
            sums.add(hit.back ? front : back, weight * s.transmitted);
        }
    }
    rows_[receiver] = sums.finish(channels_);
}

std::size_t GatherOperator::entries() const {
    std::size_t sum = 0;
    for (const Row& row : rows_)
        sum += row.count;
    return sum;
}

std::size_t GatherOperator::bytes() const {
    return rows_.size() * sizeof(Row) + entries() * (4 + 4 * static_cast<std::size_t>(channels_));
}

void GatherOperator::apply(int order, std::span<const float> from, std::span<float> to, int threads) const {
    parallel_for(rows_.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
        apply_block(order, *this, begin, end, from.data(), to.data());
    });
}

} // namespace prt
