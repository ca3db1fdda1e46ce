#pragma once

// Interreflection as a sparse linear operator (docs/math.md, section 7).

#include "bake/scene/surfaces.h"
#include "bake/scene/transport_receivers.h"
#include "bake/trace/tracer.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace prt {

/// Returns the reflectance of the surface at each receiver, [receivers], if it is the same in all triangles
/// of the receiver; empty if a surface varies within a triangle or transmits light.
std::vector<glm::vec3> shared_reflectance(const Surfaces& surfaces, const TransportReceivers& receivers);

/// The gather F: (F X)_p,c = sum over entries of weight_c X_source,c. Rows are receivers, or samples of the
/// surface. If the reflectance depends only on the source, X is scaled by it beforehand and an entry has one
/// weight for all channels.
class GatherOperator {
public:
    /// Keeps references to its arguments.
    GatherOperator(const Surfaces& surfaces, const TransportReceivers& receivers, std::size_t rows,
                   int channels);

    /// Sets a row from the hits of its `rays` rays. Rows may be set from several threads.
    void set_row(std::size_t row, std::span<const Hit> hits, int rays);
    std::size_t rows() const { return rows_.size(); }
    /// Upper bound: a row has at most three entries per ray, each with a source and a weight per channel.
    static constexpr double kMaxBytesPerRay = 3 * 16;

    std::size_t entries() const;
    std::size_t bytes() const;

    /// Multiplies exit transfer [receivers][channels][order²] by the reflectance at its receivers.
    void reflect(int order, std::span<float> exit, int threads) const;

    /// Computes to = F from for the rows from `first` on; `to` is [rows][channels][order²]. `from` must be
    /// reflected.
    void apply(int order, std::span<const float> from, std::size_t first, std::span<float> to,
               int threads) const;

    /// Computes to = F from for `from` that is not reflected, with sums in double precision; slower.
    void apply_in_double(int order, std::span<const float> from, std::size_t first, std::span<double> to,
                         int threads) const;

    struct Row {
        std::uint32_t count = 0;
        std::unique_ptr<std::uint32_t[]> sources; ///< [count]
        std::unique_ptr<float[]> weights;         ///< [count][channels, or 1 if the reflectance is shared]
    };

    int channels() const { return channels_; }
    std::size_t receivers() const { return receivers_.receivers.size(); }
    std::span<const Row> all_rows() const { return rows_; }
    /// [receivers], or empty if an entry has a weight per channel.
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
