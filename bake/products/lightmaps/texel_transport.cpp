// Gathers light from vertices of the traced scene. There are many texels, so rows are created and discarded
// in blocks; bounces before the last one use only the rows of vertices.

#include "bake/products/lightmaps/texel_transport.h"

#include "bake/pipeline/lamps_of_plan.h"
#include "bake/plan/transfer_terms.h"
#include "bake/products/lightmaps/texel_samples.h"
#include "prt/core/sh_basis.h"

#include <algorithm>

namespace prt {

TexelTransport::TexelTransport(const BakePlan& plan, BounceSources sources, std::size_t rows)
    : plan_(plan), gather_(plan.gather_rows(plan.bounces != 0 ? rows : 0)),
      sky_order_(sources.sky.layout.order) {
    const int threads = plan.options.threads;
    const auto reflected = [&](Transfer exit) {
        gather_.reflect(exit.layout.order, exit.vectors, threads);
        return std::move(exit.vectors);
    };
    if (plan.bounces != 0)
        sky_ = reflected(std::move(sources.sky));
    if (plan.lamps.empty())
        return;
    lamp_layout_ = sources.lamps.layout;
    if (plan.bounces == 0)
        return;
    connections_.emplace(std::move(*sources.connections));
    lamp_rows_.emplace(plan, rows, false);
    if (plan.channels == lamp_layout_.channels())
        lamps_.push_back(reflected(std::move(sources.lamps)));
    else
        for (int c = 0; c < 3; ++c)
            lamps_.push_back(reflected(one_channel(sources.lamps, c)));
}

std::size_t TexelTransport::sky_stride() const {
    return bounces() || !plan_.diffusion.empty()
               ? static_cast<std::size_t>(plan_.channels * coefficient_count(plan_.options.order))
               : 0;
}

std::size_t TexelTransport::lamp_stride() const {
    return lamp_layout_.dimension();
}

void TexelTransport::clear() {
    for (std::size_t row = 0; row < gather_.rows(); ++row) {
        gather_.set_row(row, {}, 1);
        if (lamp_rows_)
            lamp_rows_->set(row, {}, 1);
    }
}

void TexelTransport::set_row(std::size_t row, const Receivers& receivers, std::span<const Hit> hits,
                             const TraceOptions& options) {
    gather_.set_row(row, hits, options.rays);
    if (lamp_rows_)
        lamp_rows_->set(row, connections_->join(receivers, static_cast<std::uint32_t>(row), hits, options),
                        options.rays);
}

void TexelTransport::gather_sky(std::span<float> to) const {
    if (bounces())
        gather_.apply(sky_order_, sky_, 0, to, plan_.options.threads);
}

std::size_t TexelTransport::light_of_lamps(Tracer& tracer, const Receivers& receivers, std::uint64_t seed,
                                           std::span<float> direct, std::span<float> bounced,
                                           const Progress& progress) const {
    const LampLight light =
        prt::light_of_lamps(plan_, tracer, receivers, {.divisor = kSamplesOfTexel, .seed = seed}, progress);
    if (plan_.options.lamps.mode == LampMode::all)
        std::ranges::copy(light.transfer.vectors, direct.begin());
    std::vector<float> some;
    for (std::size_t part = 0; part < lamps_.size(); ++part) {
        const std::size_t stride = lamp_stride() / lamps_.size();
        some.resize(receivers.size() * stride);
        lamp_rows_->all.apply(lamp_layout_.order, lamps_[part], 0, some, plan_.options.threads);
        for (std::size_t r = 0; r < receivers.size(); ++r)
            for (std::size_t i = 0; i < stride; ++i)
                bounced[r * lamp_stride() + part * stride + i] = some[r * stride + i];
    }
    return light.rays;
}

} // namespace prt
