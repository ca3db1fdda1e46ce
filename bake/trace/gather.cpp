// Gathers the light of surfaces into rows, one row per receiver (docs/math.md, section 7).

#include "bake/trace/gather.h"

#include "bake/trace/sparse_rows.h"
#include "prt/core/sh_basis.h"
#include "runtime/core/support/parallel.h"

#include <algorithm>
#include <type_traits>

namespace prt {
namespace {

/// Sums weights by source. Reuses its memory for all rows; one per thread.
template <class Weight>
class RowSums {
public:
    void begin(std::size_t receivers) {
        entry_of_.resize(receivers, kNoEntry);
        sources_.clear();
        weights_.clear();
    }

    void add(std::uint32_t source, const Weight& weight) {
        std::uint32_t& entry = entry_of_[source];
        if (entry == kNoEntry) {
            entry = static_cast<std::uint32_t>(sources_.size());
            sources_.push_back(source);
            weights_.push_back(weight);
        } else {
            weights_[entry] += weight;
        }
    }

    GatherOperator::Row finish(int weights_per_entry) {
        for (const std::uint32_t source : sources_)
            entry_of_[source] = kNoEntry;
        GatherOperator::Row row;
        const auto width = static_cast<std::size_t>(weights_per_entry);
        row.count = static_cast<std::uint32_t>(sources_.size());
        row.sources = std::make_unique_for_overwrite<std::uint32_t[]>(sources_.size());
        row.weights = std::make_unique_for_overwrite<float[]>(sources_.size() * width);
        std::copy(sources_.begin(), sources_.end(), row.sources.get());
        for (std::size_t e = 0; e < weights_.size(); ++e)
            std::copy_n(reinterpret_cast<const float*>(&weights_[e]), width, &row.weights[e * width]);
        return row;
    }

private:
    static constexpr std::uint32_t kNoEntry = ~0u;
    std::vector<std::uint32_t> entry_of_; ///< [receivers]
    std::vector<std::uint32_t> sources_;
    std::vector<Weight> weights_;
};

} // namespace

std::vector<glm::vec3> shared_reflectance(const Surfaces& surfaces, const TransportReceivers& receivers) {
    std::vector<glm::vec3> reflectance(receivers.receivers.size(), glm::vec3(-1));
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const std::optional<Scattering> scattering = surfaces.constant_scattering(t);
        if (!scattering || surfaces.transmits(t))
            return {};
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t front = surfaces.corners(t)[corner];
            for (const std::uint32_t side : {front, receivers.back_of(front)}) {
                if (side == kNoReceiver)
                    continue;
                if (reflectance[side].x >= 0 && reflectance[side] != scattering->reflected)
                    return {};
                reflectance[side] = scattering->reflected;
            }
        }
    }
    return reflectance;
}

GatherOperator::GatherOperator(const Surfaces& surfaces, const TransportReceivers& receivers,
                               std::size_t rows, int channels)
    : surfaces_(surfaces), receivers_(receivers), channels_(channels),
      reflectance_(shared_reflectance(surfaces, receivers)), rows_(rows) {}

template <bool Colored>
GatherOperator::Row GatherOperator::make_row(std::span<const Hit> hits, int rays) const {
    using Weight = std::conditional_t<Colored, glm::vec3, float>;
    thread_local RowSums<Weight> sums;
    sums.begin(receivers_.receivers.size());
    for (const Hit& hit : hits) {
        if (hit.back && !surfaces_.two_sided(hit.triangle))
            continue; // the inside of a solid: it blocks, and no light comes from there
        const glm::uvec3& corners = surfaces_.corners(hit.triangle);
        const glm::vec3 barycentrics(1 - hit.u - hit.v, hit.u, hit.v);
        const float share = hit.weight / static_cast<float>(rays);
        if constexpr (Colored) {
            const Scattering s = surfaces_.scattering({hit.triangle, {hit.u, hit.v}, hit.footprint});
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t front = corners[corner], back = receivers_.back_of(front);
                const float weight = share * barycentrics[corner];
                const std::uint32_t near = hit.back ? back : front, far = hit.back ? front : back;
                if (s.reflected != glm::vec3(0))
                    sums.add(near, weight * s.reflected);
                if (far != kNoReceiver && s.transmitted != glm::vec3(0))
                    sums.add(far, weight * s.transmitted);
            }
        } else {
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t front = corners[corner];
                const std::uint32_t side = hit.back ? receivers_.back_of(front) : front;
                if (reflectance_[side] != glm::vec3(0))
                    sums.add(side, share * barycentrics[corner]);
            }
        }
    }
    return sums.finish(Colored ? channels_ : 1);
}

void GatherOperator::set_row(std::size_t row, std::span<const Hit> hits, int rays) {
    rows_[row] = reflectance_.empty() ? make_row<true>(hits, rays) : make_row<false>(hits, rays);
}

std::size_t GatherOperator::entries() const {
    std::size_t sum = 0;
    for (const Row& row : rows_)
        sum += row.count;
    return sum;
}

std::size_t GatherOperator::bytes() const {
    const std::size_t weights = reflectance_.empty() ? static_cast<std::size_t>(channels_) : 1;
    return rows_.size() * sizeof(Row) + entries() * (4 + 4 * weights);
}

void GatherOperator::reflect(int order, std::span<float> exit, int threads) const {
    const auto coefficients = static_cast<std::size_t>(coefficient_count(order));
    const std::size_t stride = coefficients * static_cast<std::size_t>(channels_);
    parallel_for(reflectance_.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            for (std::size_t i = 0; i < stride; ++i)
                exit[p * stride + i] *= reflectance_[p][static_cast<int>(i / coefficients)];
    });
}

void GatherOperator::apply(int order, std::span<const float> from, std::size_t first, std::span<float> to,
                           int threads) const {
    const std::size_t stride =
        static_cast<std::size_t>(coefficient_count(order)) * static_cast<std::size_t>(channels_);
    parallel_for(to.size() / stride, 64, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<SparseRow> rows;
        for (std::size_t p = first + begin; p < first + end; ++p)
            rows.push_back({rows_[p].count, rows_[p].sources.get(), rows_[p].weights.get()});
        apply_rows(order, channels_, !reflectance_.empty(), rows, from.data(), &to[begin * stride]);
    });
}

void GatherOperator::apply_in_double(int order, std::span<const float> from, std::size_t first,
                                     std::span<double> to, int threads) const {
    const auto coefficients = static_cast<std::size_t>(coefficient_count(order));
    const auto channels = static_cast<std::size_t>(channels_);
    const std::size_t stride = coefficients * channels;
    const bool shared = !reflectance_.empty();
    parallel_for(to.size() / stride, 64, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            double* const sums = &to[p * stride];
            std::fill_n(sums, stride, 0.0);
            const Row& row = rows_[first + p];
            for (std::size_t e = 0; e < row.count; ++e)
                for (std::size_t c = 0; c < channels; ++c) {
                    const std::uint32_t source = row.sources[e];
                    const double weight =
                        shared ? static_cast<double>(row.weights[e]) *
                                     static_cast<double>(reflectance_[source][static_cast<int>(c)])
                               : static_cast<double>(row.weights[e * channels + c]);
                    const float* const values = &from[source * stride + c * coefficients];
                    for (std::size_t i = 0; i < coefficients; ++i)
                        sums[c * coefficients + i] += weight * static_cast<double>(values[i]);
                }
        }
    });
}

} // namespace prt
