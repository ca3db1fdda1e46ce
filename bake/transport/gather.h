#pragma once

// Interreflection as a sparse linear operator (docs/math.md, section 7).

#include "prt/surfaces.h"
#include "prt/tracer.h"
#include "transport/transport_receivers.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace prt {

/// Reflectance of the surface at each receiver, [receivers], where it is the same wherever the receiver is a
/// corner; empty where some surface varies within a triangle or lets light through.
std::vector<glm::vec3> shared_reflectance(const Surfaces& surfaces, const TransportReceivers& receivers);

/// The gather F: (F X)_p,c = sum over entries of weight_c X_source,c. Rows are receivers, or samples of the
/// surface. Where the reflectance belongs to the source alone, X is scaled by it beforehand and an entry has
/// one weight for all channels.
class GatherOperator {
public:
    /// Keeps references to its arguments.
    GatherOperator(const Surfaces& surfaces, const TransportReceivers& receivers, std::size_t rows,
                   int channels);

    /// Makes a row from what `rays` of its rays met. Rows may be made from several threads.
    void set_row(std::size_t row, std::span<const Hit> hits, int rays);
    std::size_t rows() const { return rows_.size(); }
    /// A row holds three entries per ray at most, each a source and a weight per channel.
    static constexpr double kMostBytesPerRay = 3 * 16;

    std::size_t entries() const;
    std::size_t bytes() const;

    /// Multiplies exit transfer [receivers][channels][order²] by the reflectance that belongs to it.
    void reflect(int order, std::span<float> exit, int threads) const;

    /// to = F from for the rows from `first` on, as many as `to` [rows][channels][order²] has, where `from`
    /// was reflected.
    void apply(int order, std::span<const float> from, std::size_t first, std::span<float> to,
               int threads) const;

    /// The same from what was not reflected, with sums in double, slower.
    void apply_in_double(int order, std::span<const float> from, std::size_t first, std::span<double> to,
                         int threads) const;

    struct Row {
        std::uint32_t count = 0;
        std::unique_ptr<std::uint32_t[]> sources; ///< [count]
        std::unique_ptr<float[]> weights;         ///< [count][channels, or 1 where reflectance is shared]
    };

    int channels() const { return channels_; }
    std::size_t receivers() const { return receivers_.receivers.size(); }
    std::span<const Row> all_rows() const { return rows_; }
    /// [receivers], or nothing where an entry has a weight per channel.
    std::span<const glm::vec3> reflectance() const { return reflectance_; }

private:
    template <bool Colored>
    Row make_row(std::span<const Hit> hits, int rays) const;

    const Surfaces& surfaces_;
    const TransportReceivers& receivers_;
    int channels_;
    std::vector<glm::vec3> reflectance_;
    std::vector<Row> rows_;
};

} // namespace prt
