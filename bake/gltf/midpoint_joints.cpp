// Computes joints and weights of edge midpoints (glTF 2.0, section 3.7.3.3).
#include "bake/gltf/midpoint_joints.h"

#include "bake/gltf/gathered_accessor.h"
#include "prt/core/error.h"
#include "runtime/load/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// A joint and its weight.
struct Influence {
    std::uint32_t joint = 0;
    double weight = 0;
};

/// All sets of a vertex array, in types that can hold each of them.
struct Skinning {
    std::size_t sets = 0;
    int joint_type = kUnsignedByte, weight_type = -1; ///< component types
    std::vector<Influence> influences;                ///< [vertices][4 sets]
};

std::string name_of(const char* kind, std::size_t set) {
    return kind + std::to_string(set);
}

Skinning read_skinning(const GltfModel& model, const Json& attributes) {
    Skinning skin;
    while (attributes.contains(name_of("JOINTS_", skin.sets)) &&
           attributes.contains(name_of("WEIGHTS_", skin.sets)))
        ++skin.sets;
    for (std::size_t set = 0; set < skin.sets; ++set) {
        const int joints_at = attributes[name_of("JOINTS_", set)].get<int>(),
                  weights_at = attributes[name_of("WEIGHTS_", set)].get<int>();
        const std::vector<std::uint32_t> joints = read_unsigned(model, joints_at, 4);
        const std::vector<float> weights = read_floats(model, weights_at, 4);
        if (set == 0)
            skin.influences.resize(joints.size() * skin.sets);
        if (joints.size() != weights.size() || joints.size() * skin.sets != skin.influences.size())
            throw Error("JOINTS and WEIGHTS have different numbers of elements");
        for (std::size_t i = 0; i < joints.size(); ++i)
            skin.influences[(i / 4 * skin.sets + set) * 4 + i % 4] = {joints[i],
                                                                      static_cast<double>(weights[i])};
        const int joint_type = get_accessor(model, joints_at).componentType,
                  weight_type = get_accessor(model, weights_at).componentType;
        skin.joint_type = std::max(skin.joint_type, joint_type); // a larger constant is the wider type
        skin.weight_type = set == 0 || skin.weight_type == weight_type ? weight_type : kFloat;
    }
    return skin;
}

/// Returns the `most` joints of both ends with the largest weights; each end contributes half, and the sum is
/// one. All zero if neither end has any.
std::vector<Influence> middle(std::span<const Influence> a, std::span<const Influence> b, std::size_t most) {
    std::map<std::uint32_t, double> sums;
    for (const auto& end : {a, b}) {
        double total = 0;
        for (const Influence& i : end)
            total += std::max(i.weight, 0.0);
        for (const Influence& i : end)
            if (i.weight > 0)
                sums[i.joint] += i.weight / total;
    }
    std::vector<Influence> all;
    for (const auto& [joint, weight] : sums)
        all.push_back({joint, weight});
    std::stable_sort(all.begin(), all.end(),
                     [](const Influence& x, const Influence& y) { return x.weight > y.weight; });
    all.resize(most);
    double total = 0;
    for (const Influence& i : all)
        total += i.weight;
    for (Influence& i : all)
        i.weight = total > 0 ? i.weight / total : 0;
    return all;
}

/// Rounds weights to multiples of 1 / `one` with sum 1: the remainder goes to the weights with the largest
/// rounding loss.
void round_weights(std::span<Influence> influences, double one) {
    double missing = one;
    std::vector<std::pair<double, std::size_t>> lost;
    for (std::size_t i = 0; i < influences.size(); ++i) {
        const double exact = influences[i].weight * one, whole = std::floor(exact);
        lost.emplace_back(whole - exact, i);
        influences[i].weight = whole / one;
        missing -= whole;
    }
    std::stable_sort(lost.begin(), lost.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
    for (std::size_t i = 0; i < lost.size() && missing > 0; ++i, --missing)
        influences[lost[i].second].weight += 1 / one;
}

void append_middles(Skinning& skin, std::span<const Midpoint> midpoints) {
    const std::size_t most = 4 * skin.sets;
    for (const Midpoint& m : midpoints) {
        const std::span all(std::as_const(skin.influences));
        std::vector<Influence> here =
            middle(all.subspan(m.first * most, most), all.subspan(m.second * most, most), most);
        const bool any = here.front().weight > 0;
        if (any && skin.weight_type == kUnsignedByte)
            round_weights(here, std::numeric_limits<std::uint8_t>::max());
        if (any && skin.weight_type == kUnsignedShort)
            round_weights(here, std::numeric_limits<std::uint16_t>::max());
        for (Influence& i : here)
            if (i.weight == 0)
                i.joint = 0; // required by glTF
        skin.influences.insert(skin.influences.end(), here.begin(), here.end());
    }
}

/// Adds one number of every influence of a set, in the component type of `accessor`.
template <class Number>
std::size_t add_set(GltfContents& contents, Json accessor, const Skinning& skin, std::size_t set,
                    const Number& number) {
    std::size_t added = 0;
    with_component_type(accessor["componentType"].get<int>(), [&](auto type) {
        std::vector<decltype(type)> values;
        for (std::size_t i = 0; i < skin.influences.size() / skin.sets; ++i) {
            const Influence& influence = skin.influences[(i / 4 * skin.sets + set) * 4 + i % 4];
            values.push_back(static_cast<decltype(type)>(number(influence, type)));
        }
        added = add_vertex_accessor(contents, accessor, std::as_bytes(std::span(values)));
    });
    return added;
}

/// Returns a weight in its stored type.
template <class Stored>
double stored_weight(double weight, Stored) {
    if constexpr (std::is_integral_v<Stored>)
        return std::round(weight * static_cast<double>(std::numeric_limits<Stored>::max()));
    else
        return weight;
}

} // namespace

void add_midpoint_joints(GltfContents& contents, Json& attributes, std::span<const Midpoint> midpoints) {
    Skinning skin = read_skinning(contents.model, attributes);
    if (skin.sets == 0)
        return;
    append_middles(skin, midpoints);
    for (std::size_t set = 0; set < skin.sets; ++set) {
        Json &joints = attributes[name_of("JOINTS_", set)], &weights = attributes[name_of("WEIGHTS_", set)];
        const auto like = [&](const Json& reference, int component_type) {
            Json accessor = contents.json["accessors"][reference.get<std::size_t>()];
            accessor["componentType"] = component_type;
            if (component_type == kFloat)
                accessor.erase("normalized");
            return accessor;
        };
        joints = add_set(contents, like(joints, skin.joint_type), skin, set,
                         [](const Influence& i, auto) { return i.joint; });
        weights = add_set(contents, like(weights, skin.weight_type), skin, set,
                          [](const Influence& i, auto type) { return stored_weight(i.weight, type); });
    }
}

} // namespace prt
