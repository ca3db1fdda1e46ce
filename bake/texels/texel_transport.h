#pragma once

// Light that comes to texels beside that of the sky: from surfaces that light bounced off, and from lamps.

#include "bounced_sources.h"
#include "prt/tracer.h"
#include "transport/gather.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

class TexelTransport {
public:
    /// Takes `rows` texels at a time. Keeps a reference to `plan`.
    TexelTransport(const BakePlan& plan, BouncedSources sources, std::size_t rows);

    bool bounces() const { return plan_.bounces != 0; }
    std::size_t rows() const { return gather_.rows(); }
    /// Numbers that a texel has of bounced sky light, and of lamps; 0 where there is none.
    std::size_t sky_stride() const;
    std::size_t lamp_stride() const;

    /// Notes what rays of row `row`, those of receiver `row`, met. Thread-safe. A triangle that rays start on
    /// is no exception: an interpolated normal sends some below it, and whatever they miss would be lost.
    void set_row(std::size_t row, const Receivers& receivers, std::span<const Hit> hits,
                 const TraceOptions& options);
    /// Forgets what rows met.
    void clear();
    /// Bounced sky light of the first rows, `to` [rows][sky_stride()].
    void gather_sky(std::span<float> to) const;
    /// Light of lamps at `receivers`, one for each of the first rows, without a bounce and bounced,
    /// [rows][lamp_stride()] each, by samples of `seed`. Returns how many rays it took.
    std::size_t light_of_lamps(Tracer& tracer, const Receivers& receivers, std::uint64_t seed,
                               std::span<float> direct, std::span<float> bounced,
                               const Progress& progress) const;
    /// How lamp light is laid out: coefficient k is that of lamp k.
    const TransferLayout& lamp_layout() const { return lamp_layout_; }

private:
    const BakePlan& plan_;
    GatherOperator gather_;
    std::optional<LampConnections> connections_; ///< where lamps bounce
    std::optional<LampRows> lamp_rows_;
    int sky_order_ = 0;
    std::vector<float> sky_; ///< reflected
    std::vector<std::vector<float>>
        lamps_; ///< the same; each color apart where surfaces are grey and lamps not
    TransferLayout lamp_layout_;
};

} // namespace prt
