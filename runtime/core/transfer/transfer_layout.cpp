// Layouts of transfer vectors, and the light of each term.
#include "prt/core/transfer_layout.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/printable.h"

#include <algorithm>
#include <cassert>
#include <set>

namespace prt {
namespace {

void check_bands(std::span<const glm::vec3> light, const TransferLayout& layout) {
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order));
    if (light.size() < count)
        throw Error("the lighting has " + counted(light.size(), "coefficient") + ", but transfer of order " +
                    std::to_string(layout.order) + " needs " + std::to_string(count));
}

void check_strengths(std::span<const glm::vec3> lamps, const TransferLayout& layout) {
    if (!lamps.empty() && lamps.size() != layout.lamps())
        throw Error("the lighting has " + std::to_string(lamps.size()) +
                    " lamp strengths, but the transfer has " + counted(layout.lamps(), "lamp"));
}

void check_lamps(const TransferLayout& layout) {
    if (layout.lamps() > kMaxLamps)
        throw Error("the transfer has " + std::to_string(layout.lamps()) + " lamps; the limit is " +
                    std::to_string(kMaxLamps));
    constexpr const char* kNames =
        "each lamp of the transfer must have a name, and other terms must not have one";
    for (const TransferTerm& term : layout.distant_terms()) {
        if (!term.name.empty())
            throw Error(kNames);
        if (!term.members.empty())
            throw Error("a term of the transfer has members, but is not a lamp");
    }
    std::set<std::string> names;
    for (const TransferTerm& term : layout.lamp_terms()) {
        if (term.name.empty())
            throw Error(kNames);
        if (!names.insert(term.name).second)
            throw Error("two lamps of the transfer have the name '" + printable(term.name) + "'");
    }
}

} // namespace

bool TransferTerm::has_member(const std::string& member) const {
    return members.empty() ? name == member : std::ranges::find(members, member) != members.end();
}

const char* to_string(TermKind kind) {
    switch (kind) {
    case TermKind::direct:
        return "direct";
    case TermKind::indirect:
        return "indirect";
    case TermKind::lamp:
        return "lamp";
    case TermKind::combined:
        break;
    }
    return "combined";
}

int TransferLayout::channels() const {
    return std::any_of(terms.begin(), terms.end(),
                       [](const TransferTerm& term) { return term.channels == 3; })
               ? 3
               : 1;
}

bool TransferLayout::has(TermKind kind) const {
    return std::any_of(terms.begin(), terms.end(),
                       [&](const TransferTerm& term) { return term.kind == kind; });
}

std::size_t TransferLayout::dimension() const {
    std::size_t numbers = 0;
    for (const TransferTerm& term : terms)
        numbers += numbers_of(term);
    return outputs * numbers;
}

std::size_t TransferLayout::columns() const {
    std::size_t columns = 0;
    for (const TransferTerm& term : terms)
        columns += columns_of(term);
    return columns;
}

std::span<const TransferTerm> TransferLayout::distant_terms() const {
    return std::span(terms).first(terms.size() - lamps());
}

std::size_t TransferLayout::distant_numbers() const {
    std::size_t numbers = 0;
    for (const TransferTerm& term : distant_terms())
        numbers += numbers_of(term);
    return numbers;
}

std::span<const TransferTerm> TransferLayout::lamp_terms() const {
    const auto first = std::find_if(terms.begin(), terms.end(),
                                    [](const TransferTerm& term) { return term.kind == TermKind::lamp; });
    return {first, terms.end()};
}

TransferLayout layout_of_one(int order, int channels, TermKind kind) {
    return {order, {{kind, channels}}};
}

void check_layout(const TransferLayout& layout) {
    check_order(layout.order);
    if (layout.terms.empty())
        throw Error("the transfer has no terms");
    if (layout.outputs != 1 && layout.outputs != 4 && layout.outputs != 9 && layout.outputs != 16)
        throw Error("the transfer has " + std::to_string(layout.outputs) +
                    " outputs, but must have 1, 4, 9 or 16");
    for (std::size_t i = 0; i < layout.terms.size(); ++i) {
        const TransferTerm& term = layout.terms[i];
        if (term.channels != 1 && term.channels != 3)
            throw Error(std::string("term '") + to_string(term.kind) + "' has " +
                        std::to_string(term.channels) + " channels, but must have 1 or 3");
        if (term.kind == TermKind::lamp)
            continue;
        if (i > 0 && !(layout.terms[i - 1].kind < term.kind))
            throw Error(std::string("term '") + to_string(term.kind) + "' must not follow term '" +
                        to_string(layout.terms[i - 1].kind) + "'");
        if (term.kind == TermKind::combined && i > 0)
            throw Error("term 'combined' must be the only term of distant light");
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
    for (const TransferTerm& term : layout.distant_terms())
        for (std::size_t i = 0; i < layout.columns_of(term); ++i) {
            *to = sky[i];
            if (!suns.empty() && term.kind != TermKind::direct)
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
