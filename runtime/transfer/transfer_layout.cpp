// Layouts of transfer vectors, and the light of each part.
#include "prt/transfer_layout.h"

#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/printable.h"

#include <algorithm>
#include <cassert>
#include <set>

namespace prt {
namespace {

void check_bands(std::span<const glm::vec3> light, const TransferLayout& layout) {
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order));
    if (light.size() < count)
        throw Error("the lighting has " + std::to_string(light.size()) + " coefficients, transfer of order " +
                    std::to_string(layout.order) + " needs " + std::to_string(count));
}

void check_strengths(std::span<const glm::vec3> lamps, const TransferLayout& layout) {
    if (!lamps.empty() && lamps.size() != layout.lamps())
        throw Error("the lighting has " + std::to_string(lamps.size()) + " strengths, the transfer has " +
                    std::to_string(layout.lamps()) + " lamps");
}

void check_lamps(const TransferLayout& layout) {
    if (layout.lamps() > kMaxLamps)
        throw Error("the transfer has " + std::to_string(layout.lamps()) + " lamps, more than " +
                    std::to_string(kMaxLamps));
    constexpr const char* kNames = "lamps of transfer have names, and other parts have none";
    for (const TransferPart& part : layout.distant_parts()) {
        if (!part.name.empty())
            throw Error(kNames);
        if (!part.members.empty())
            throw Error("a part of transfer that is no lamp has members");
    }
    std::set<std::string> names;
    for (const TransferPart& part : layout.lamp_parts()) {
        if (part.name.empty())
            throw Error(kNames);
        if (!names.insert(part.name).second)
            throw Error("two lamps of the transfer are called '" + printable(part.name) + "'");
    }
}

} // namespace

bool TransferPart::has_member(const std::string& member) const {
    return members.empty() ? name == member : std::ranges::find(members, member) != members.end();
}

const char* to_string(PartKind kind) {
    switch (kind) {
    case PartKind::direct:
        return "direct";
    case PartKind::indirect:
        return "indirect";
    case PartKind::lamp:
        return "lamp";
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

std::size_t TransferLayout::dimension() const {
    std::size_t numbers = 0;
    for (const TransferPart& part : parts)
        numbers += numbers_of(part);
    return outputs * numbers;
}

std::size_t TransferLayout::columns() const {
    std::size_t columns = 0;
    for (const TransferPart& part : parts)
        columns += columns_of(part);
    return columns;
}

std::span<const TransferPart> TransferLayout::distant_parts() const {
    return std::span(parts).first(parts.size() - lamps());
}

std::size_t TransferLayout::distant_numbers() const {
    std::size_t numbers = 0;
    for (const TransferPart& part : distant_parts())
        numbers += numbers_of(part);
    return numbers;
}

std::span<const TransferPart> TransferLayout::lamp_parts() const {
    const auto first = std::find_if(parts.begin(), parts.end(),
                                    [](const TransferPart& part) { return part.kind == PartKind::lamp; });
    return {first, parts.end()};
}

TransferLayout layout_of_one(int order, int channels, PartKind kind) {
    return {order, {{kind, channels}}};
}

void check_layout(const TransferLayout& layout) {
    check_order(layout.order);
    if (layout.parts.empty())
        throw Error("the transfer has no parts");
    if (layout.outputs != 1 && layout.outputs != 4 && layout.outputs != 9 && layout.outputs != 16)
        throw Error("transfer has " + std::to_string(layout.outputs) +
                    " outputs, only 1, 4, 9 or 16 make sense");
    for (std::size_t i = 0; i < layout.parts.size(); ++i) {
        const TransferPart& part = layout.parts[i];
        if (part.channels != 1 && part.channels != 3)
            throw Error(std::string("part '") + to_string(part.kind) + "' has " +
                        std::to_string(part.channels) + " channels, only 1 or 3 make sense");
        if (part.kind == PartKind::lamp)
            continue;
        if (i > 0 && !(layout.parts[i - 1].kind < part.kind))
            throw Error(std::string("part '") + to_string(part.kind) + "' stands behind part '" +
                        to_string(layout.parts[i - 1].kind) + "'");
        if (part.kind == PartKind::whole && i > 0)
            throw Error("part 'whole' stands beside other parts of the same light");
    }
    check_lamps(layout);
}

void write_light_columns(const TransferLayout& layout, const LightingView& lighting,
                         std::span<glm::vec3> columns) {
    const auto& [sky, suns, lamps] = lighting;
    check_bands(sky, layout);
    if (!suns.empty())
        check_bands(suns, layout);
    check_strengths(lamps, layout);
    assert(columns.size() >= layout.columns());
    auto to = columns.begin();
    for (const TransferPart& part : layout.distant_parts())
        for (std::size_t i = 0; i < layout.columns_of(part); ++i) {
            *to = sky[i];
            if (!suns.empty() && part.kind != PartKind::direct)
                *to += suns[i];
            ++to;
        }
    if (lamps.empty())
        std::fill_n(to, layout.lamps(), glm::vec3(1));
    else
        std::ranges::copy(lamps, to);
}

std::vector<glm::vec3> light_columns(const TransferLayout& layout, const LightingView& lighting) {
    std::vector<glm::vec3> columns(layout.columns());
    write_light_columns(layout, lighting, columns);
    return columns;
}

} // namespace prt
