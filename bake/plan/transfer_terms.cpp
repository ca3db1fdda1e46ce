// Separates direct light from bounced light: suns can then be lit with sharp shadows, and each term has only
// the channels that it needs.

#include "bake/plan/transfer_terms.h"

#include "prt/core/error.h"
#include "prt/core/sh_basis.h"
#include "runtime/core/support/printable.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

std::size_t channel_size(const Transfer& transfer) {
    return static_cast<std::size_t>(coefficient_count(transfer.layout.order));
}

TermKind kind_of(const Transfer& transfer) {
    return transfer.layout.terms.front().kind;
}

bool is_zero(const Transfer& transfer) {
    return std::all_of(transfer.vectors.begin(), transfer.vectors.end(), [](float v) { return v == 0; });
}

/// Returns `all` minus `direct`.
Transfer rest_of(const Transfer& direct, const Transfer& all) {
    Transfer rest = all;
    rest.layout.terms.front().kind = TermKind::indirect;
    const std::size_t stored = direct.dimension();
    for (std::size_t p = 0; p < rest.receivers(); ++p) {
        const std::span<float> to = rest.vector(p);
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] -= direct.vector(p)[i % stored]; // the only channel of `direct` serves all channels
    }
    return rest;
}

/// Whether coefficients [first, first + count) are equal in all channels.
bool are_grey(const Transfer& transfer, std::size_t first, std::size_t count) {
    if (transfer.layout.channels() == 1)
        return true;
    const std::size_t size = channel_size(transfer);
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const auto red = transfer.vector(p).subspan(first, count);
        for (const std::size_t c : {1u, 2u})
            if (!std::ranges::equal(red, transfer.vector(p).subspan(c * size + first, count)))
                return false;
    }
    return true;
}

} // namespace

Transfer exit_without_bounces(const BakePlan& plan, Transfer incident, const Refill& refill) {
    const std::size_t size = incident.dimension();
    incident.layout.terms.front().kind = TermKind::direct;
    refill.apply(std::span(incident.vectors), size);
    for (const DiffusionOperator& body : plan.diffusion)
        for (const std::uint32_t p : body.members())
            std::fill_n(incident.vector(p).begin(), size, 0.0f);
    return incident;
}

Transfer in_terms(const Transfer& direct, const Transfer& all) {
    return joined(direct, narrowed(rest_of(direct, all)));
}

Transfer joined(const Transfer& direct, const Transfer& rest) {
    if (is_zero(rest))
        return direct;
    if (is_zero(direct))
        return rest;
    Transfer both = zero_transfer(
        {direct.layout.order, {direct.layout.terms.front(), rest.layout.terms.front()}}, direct.receivers());
    for (std::size_t p = 0; p < both.receivers(); ++p) {
        const auto behind =
            std::copy(direct.vector(p).begin(), direct.vector(p).end(), both.vector(p).begin());
        std::copy(rest.vector(p).begin(), rest.vector(p).end(), behind);
    }
    return both;
}

Transfer with_lamps(const Transfer& sky, const Transfer& light, const std::vector<Lamp>& lamps) {
    const std::size_t stride = channel_size(light);
    TransferLayout layout = sky.layout;
    if (is_zero(sky)) // no light of the sky arrives
        layout.terms.clear();
    const std::size_t of_sky = layout.dimension();
    for (std::size_t k = 0; k < lamps.size(); ++k)
        layout.terms.push_back(
            {TermKind::lamp, are_grey(light, k, 1) ? 1 : 3, lamps[k].name, lamps[k].members});
    const std::span<const TransferTerm> terms = layout.lamp_terms();
    Transfer all = zero_transfer(layout, sky.receivers());
    for (std::size_t p = 0; p < all.receivers(); ++p) {
        auto to = std::copy_n(sky.vector(p).begin(), of_sky, all.vector(p).begin());
        for (std::size_t k = 0; k < lamps.size(); ++k)
            for (int c = 0; c < terms[k].channels; ++c) {
                *to = light.vector(p)[static_cast<std::size_t>(c) * stride + k];
                if (!(std::abs(*to++) <= kMaxTransfer))
                    throw Error(
                        fmt::format("lamp '{}' lights a vertex with a radiance above 1e6, the limit "
                                    "of files; reduce its intensity and raise its strength at runtime",
                                    printable(lamps[k].name)));
            }
    }
    return all;
}

Transfer narrowed(Transfer transfer) {
    if (transfer.layout.channels() == 1 || !are_grey(transfer, 0, channel_size(transfer)))
        return transfer;
    return one_channel(transfer, 0);
}

Transfer one_channel(const Transfer& colored, int channel) {
    Transfer one =
        zero_transfer(layout_of_one(colored.layout.order, 1, kind_of(colored)), colored.receivers());
    const std::size_t size = one.dimension();
    for (std::size_t p = 0; p < one.receivers(); ++p)
        std::ranges::copy(colored.vector(p).subspan(static_cast<std::size_t>(channel) * size, size),
                          one.vector(p).begin());
    return one;
}

Transfer in_color(const Transfer& red, const Transfer& green, const Transfer& blue) {
    Transfer wide = zero_transfer(layout_of_one(red.layout.order, 3, kind_of(red)), red.receivers());
    for (std::size_t p = 0; p < wide.receivers(); ++p) {
        auto to = wide.vector(p).begin();
        for (const Transfer* channel : {&red, &green, &blue})
            to = std::ranges::copy(channel->vector(p), to).out;
    }
    return wide;
}

} // namespace prt
