#pragma once

// Light of texels in addition to direct light of the sky: from surfaces after bounces, and from lamps.

#include "bake/pipeline/bounce_sources.h"
#include "bake/trace/gather.h"
#include "bake/trace/tracer.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

class TexelTransport {
public:
    /// Processes `rows` texels at a time. Keeps a reference to `plan`.
    TexelTransport(const BakePlan& plan, BounceSources sources, std::size_t rows);

    bool bounces() const { return plan_.bounces != 0; }
    std::size_t rows() const { return gather_.rows(); }
    /// Numbers per texel of sky light that bounced or passed media, and of lamps; 0 if there is no such
    /// light.
    std::size_t sky_stride() const;
    std::size_t lamp_stride() const;

    /// Sets row `row` from the hits of the rays of receiver `row`. Thread-safe. Hits on the triangle of the
    /// ray's origin are included: an interpolated normal sends some rays below it, and their light would
    /// otherwise be lost.
    void set_row(std::size_t row, const Receivers& receivers, std::span<const Hit> hits,
                 const TraceOptions& options);
    /// Clears the rows.
    void clear();
    /// Bounced sky light of the first rows, `to` [rows][sky_stride()]; zero without bounces.
    void gather_sky(std::span<float> to) const;
    /// Computes light of lamps at `receivers`, one for each of the first rows, without a bounce and bounced,
    /// [rows][lamp_stride()] each, with samples of `seed`. Returns the number of traced rays.
    std::size_t light_of_lamps(Tracer& tracer, const Receivers& receivers, std::uint64_t seed,
                               std::span<float> direct, std::span<float> bounced,
                               const Progress& progress) const;
    /// Layout of the light of lamps: coefficient k is the light of lamp k.
    const TransferLayout& lamp_layout() const { return lamp_layout_; }

private:
    const BakePlan& plan_;
    GatherOperator gather_;
    std::optional<LampConnections> connections_; ///< set if light of lamps bounces
    std::optional<LampRows> lamp_rows_;
    int sky_order_ = 0;
    std::vector<float> sky_;                ///< exit light, multiplied by the reflectance
    std::vector<std::vector<float>> lamps_; ///< exit light, multiplied by the reflectance; separate colors if
                                            ///< surfaces are grey and lamps are not
    TransferLayout lamp_layout_;
};

} // namespace prt
