// Computes attributes of edge midpoints.
#include "bake/gltf/midpoint_accessor.h"

#include "bake/gltf/gathered_accessor.h"
#include "runtime/load/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

namespace prt {
namespace {

/// Returns `value` in its stored type: integers are rounded, halves away from zero, identically on both sides
/// of an edge.
template <class Stored>
Stored stored(double value) {
    if constexpr (std::is_integral_v<Stored>)
        return static_cast<Stored>(std::clamp(std::round(value),
                                              static_cast<double>(std::numeric_limits<Stored>::lowest()),
                                              static_cast<double>(std::numeric_limits<Stored>::max())));
    else
        return static_cast<Stored>(value);
}

/// Returns the stored value of 1.
template <class Stored>
double one() {
    return std::is_integral_v<Stored> ? static_cast<double>(std::numeric_limits<Stored>::max()) : 1.0;
}

/// Computes the midpoint of `a` and `b`, [components] each.
template <class Stored>
void write_middle(const Stored* a, const Stored* b, std::size_t components, MidpointRule rule, Stored* to) {
    if (rule == MidpointRule::first) {
        std::copy_n(a, components, to);
        return;
    }
    const auto mean = [&](std::size_t c) {
        return 0.5 * (static_cast<double>(a[c]) + static_cast<double>(b[c]));
    };
    const std::size_t measures =
        rule == MidpointRule::unit ? std::min<std::size_t>(components, 3) : components;
    double length = 1;
    if (rule == MidpointRule::unit) {
        double squared = 0;
        for (std::size_t c = 0; c < measures; ++c)
            squared += mean(c) * mean(c);
        length = std::sqrt(squared) / one<Stored>();
        if (!(length > 0 && std::isfinite(length))) { // opposite ends
            std::copy_n(a, components, to);
            return;
        }
    }
    for (std::size_t c = 0; c < measures; ++c)
        to[c] = stored<Stored>(mean(c) / length);
    for (std::size_t c = measures; c < components; ++c)
        to[c] = a[c];
}

template <class Stored>
void append_middles(std::vector<Stored>& values, std::size_t components, std::span<const Midpoint> midpoints,
                    MidpointRule rule) {
    std::size_t next = values.size();
    values.resize(next + midpoints.size() * components);
    for (const Midpoint& m : midpoints) {
        write_middle(&values[m.first * components], &values[m.second * components], components, rule,
                     &values[next]);
        next += components;
    }
}

} // namespace

MidpointRule midpoint_rule(const GltfModel& model, std::string_view name, int accessor, AttributeOf owner) {
    const GltfAccessor& a = get_accessor(model, accessor);
    const bool whole_numbers = a.componentType != kFloat && !a.normalized;
    if (name == "POSITION")
        return MidpointRule::float_mean;
    if (name == "NORMAL" || name == "TANGENT")
        return owner == AttributeOf::vertex ? MidpointRule::unit : MidpointRule::mean;
    if (name.starts_with("TEXCOORD_"))
        return whole_numbers ? MidpointRule::float_mean : MidpointRule::mean;
    // Integers of applications may be counts or identifiers: 4 is not between 3 and 5.
    return whole_numbers ? MidpointRule::first : MidpointRule::mean;
}

std::size_t add_midpoint_accessor(GltfContents& contents, int reference, std::span<const Midpoint> midpoints,
                                  MidpointRule rule) {
    Json accessor = contents.json["accessors"][static_cast<std::size_t>(reference)];
    const GltfAccessor& old = get_accessor(contents.model, reference);
    const auto components = static_cast<std::size_t>(old.components);
    if (rule == MidpointRule::float_mean) {
        std::vector<float> values = read_floats(contents.model, reference, static_cast<int>(components));
        append_middles(values, components, midpoints, rule);
        accessor["componentType"] = kFloat;
        accessor.erase("normalized");
        return add_vertex_accessor(contents, std::move(accessor), std::as_bytes(std::span(values)));
    }
    const std::vector<std::byte> elements = read_elements(contents.model, reference);
    std::size_t added = 0;
    with_component_type(old.componentType, [&](auto type) {
        std::vector<decltype(type)> values(elements.size() / sizeof type);
        if (!values.empty())
            std::memcpy(values.data(), elements.data(), elements.size());
        append_middles(values, components, midpoints, rule);
        added = add_vertex_accessor(contents, std::move(accessor), std::as_bytes(std::span(values)));
    });
    return added;
}

} // namespace prt
