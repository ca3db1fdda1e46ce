// Layouts of transfer vectors, and the light that each part is lit by.
#include "prt/transfer_layout.h"

#include "prt/sh.h"
#include "prt/support/error.h"

#include <algorithm>
#include <cassert>
#include <string>

namespace prt {
namespace {

void check_bands(std::span<const glm::vec3> light, const TransferLayout& layout) {
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order));
    if (light.size() < count)
        throw Error("the lighting has " + std::to_string(light.size()) + " coefficients, transfer of order " +
                    std::to_string(layout.order) + " needs " + std::to_string(count));
}

} // namespace

const char* to_string(PartKind kind) {
    switch (kind) {
    case PartKind::direct:
        return "direct";
    case PartKind::indirect:
        return "indirect";
    case PartKind::whole:
        break;
    }
    return "whole";
}

int TransferLayout::channels() const {
    return std::any_of(parts.begin(), parts.end(),
                       [](const TransferPart& part) { return part.channels == 3; })
               ? 3
               : 1;
}

bool TransferLayout::has(PartKind kind) const {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const TransferPart& part) { return part.kind == kind; });
}

std::size_t TransferLayout::blocks() const {
    std::size_t blocks = 0;
    for (const TransferPart& part : parts)
        blocks += static_cast<std::size_t>(part.channels);
    return blocks;
}

TransferLayout layout_of_one(int order, int channels, PartKind kind) {
    return {order, {{kind, channels}}};
}

void check_layout(const TransferLayout& layout) {
    check_order(layout.order);
    if (layout.parts.empty())
        throw Error("the transfer has no parts");
    for (std::size_t i = 0; i < layout.parts.size(); ++i) {
        const TransferPart& part = layout.parts[i];
        if (part.channels != 1 && part.channels != 3)
            throw Error(std::string("part '") + to_string(part.kind) + "' has " +
                        std::to_string(part.channels) + " channels, only 1 or 3 make sense");
        if (i > 0 && !(layout.parts[i - 1].kind < part.kind))
            throw Error(std::string("part '") + to_string(part.kind) + "' stands behind part '" +
                        to_string(layout.parts[i - 1].kind) + "'");
        if (part.kind == PartKind::whole && layout.parts.size() > 1)
            throw Error("part 'whole' stands beside other parts of the same light");
    }
}

void write_light_columns(const TransferLayout& layout, const LightingView& lighting,
                         std::span<glm::vec3> columns) {
    const auto& [sky, suns] = lighting;
    check_bands(sky, layout);
    if (!suns.empty())
        check_bands(suns, layout);
    assert(columns.size() >= layout.columns());
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order));
    auto to = columns.begin();
    for (const TransferPart& part : layout.parts)
        for (std::size_t i = 0; i < count; ++i) {
            *to = sky[i];
            if (!suns.empty() && part.kind != PartKind::direct)
                *to += suns[i];
            ++to;
        }
}

std::vector<glm::vec3> light_columns(const TransferLayout& layout, const LightingView& lighting) {
    std::vector<glm::vec3> columns(layout.columns());
    write_light_columns(layout, lighting, columns);
    return columns;
}

} // namespace prt
