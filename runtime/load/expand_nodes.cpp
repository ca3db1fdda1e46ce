// Converts instances of EXT_mesh_gpu_instancing to nodes.
#include "runtime/load/expand_nodes.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/transfer_json.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Maximum number of instances. Accessors without data can claim any number.
constexpr std::size_t kMaxInstances = 1'000'000;
/// Bytes of a node, in the JSON and in the model, and of each of its weights.
constexpr double kNode = 1400, kWeight = 40;

/// Component of the transform of every instance: [instance][component]; empty: missing.
struct Attribute {
    const char* name; ///< in the extension
    const char* key;  ///< in a node
    std::size_t components;
    std::vector<double> GltfNode::*member;
    std::vector<float> values = {};
};

/// Reads an attribute. Throws `Error` for types that the extension does not allow, and for invalid
/// transforms.
std::vector<float> read_attribute(const GltfModel& model, int index, const Attribute& attribute) {
    const GltfAccessor& accessor = get_accessor(model, index);
    const bool rotations = attribute.components == 4;
    const bool small = accessor.componentType == kSignedByte || accessor.componentType == kSignedShort;
    if (accessor.componentType != kFloat && !(rotations && small && accessor.normalized))
        throw Error(std::string(attribute.name) + " of its instances must contain " +
                    (rotations ? "floats, or normalized signed bytes or shorts" : "floats"));
    std::vector<float> values = read_floats(model, index, static_cast<int>(attribute.components));
    for (std::size_t first = 0; first < values.size(); first += attribute.components) {
        const std::span<const float> one = std::span(values).subspan(first, attribute.components);
        const std::string name =
            std::string(attribute.name) + " of instance " + std::to_string(first / attribute.components);
        if (!std::ranges::all_of(one, [](float number) { return std::isfinite(number); }))
            throw Error(name + " is not finite");
        if (rotations && std::ranges::all_of(one, [](float number) { return number == 0; }))
            throw Error(name + " is not a rotation: all components are 0");
    }
    return values;
}

std::vector<Attribute> read_attributes(const GltfData& data, const Json& references, std::size_t& count) {
    std::vector<Attribute> attributes = {{"TRANSLATION", "translation", 3, &GltfNode::translation},
                                         {"ROTATION", "rotation", 4, &GltfNode::rotation},
                                         {"SCALE", "scale", 3, &GltfNode::scale}};
    bool first = true;
    for (const auto& item : references.items()) {
        const auto index = item.value().get<std::size_t>();
        if (index >= data.model.accessors.size())
            throw Error("accessor " + std::to_string(index) + " of its instances does not exist");
        if (!std::exchange(first, false) && data.model.accessors[index].count != count)
            throw Error("the attributes of its instances have different numbers of elements");
        count = data.model.accessors[index].count;
    }
    if (count > kMaxInstances)
        throw Error("has " + std::to_string(count) + " instances; at most " + std::to_string(kMaxInstances) +
                    " are supported");
    for (Attribute& attribute : attributes)
        if (references.contains(attribute.name))
            attribute.values = read_attribute(data.model, references[attribute.name].get<int>(), attribute);
    return attributes;
}

/// Moves the mesh of node `n` to one new child per instance; returns their number. `bytes` is the memory of
/// previous instances.
std::size_t expand(GltfData& data, std::size_t n, double& bytes) {
    Json& nodes = data.json["nodes"];
    std::size_t count = 0;
    const auto attributes =
        read_attributes(data, nodes[n]["extensions"][kInstancingExtension].at("attributes"), count);
    bytes += static_cast<double>(count) *
             (kNode + kWeight * static_cast<double>(data.model.nodes[n].weights.size()));
    check_scene_allowed(bytes, data, "its instances");
    ExpandedNode expanded{n, nodes.size(), count, std::move(nodes[n]["extensions"][kInstancingExtension])};
    Json shared = Json::object(); // extension of the first instance
    if (const Json* found = extension_of(nodes[n], kInstancesExtension))
        shared = *found;
    const auto first =
        shared.empty()
            ? std::size_t{0}
            : static_cast<std::size_t>(whole_number(shared.at("first"), "\"first\" of its instances", 0,
                                                    static_cast<int>(kMaxInstances) - 1));
    for (const char* name : {kInstancingExtension, kInstancesExtension})
        nodes[n]["extensions"].erase(name);
    if (nodes[n]["extensions"].empty())
        nodes[n].erase("extensions");
    Json common = Json::object();
    for (const char* key : {"mesh", "skin", "weights"})
        if (nodes[n].contains(key)) {
            common[key] = nodes[n][key];
            nodes[n].erase(key);
        }
    GltfNode common_model;
    common_model.mesh = std::exchange(data.model.nodes[n].mesh, -1);
    common_model.skin = std::exchange(data.model.nodes[n].skin, -1);
    common_model.weights = std::exchange(data.model.nodes[n].weights, {});
    for (std::size_t i = 0; i < count; ++i) {
        Json child = common;
        GltfNode model = common_model;
        for (const Attribute& attribute : attributes) {
            if (attribute.values.empty())
                continue;
            const float* values = &attribute.values[i * attribute.components];
            model.*attribute.member = {values, values + attribute.components};
            child[attribute.key] = model.*attribute.member;
        }
        if (!shared.empty()) {
            shared["first"] = first + i;
            extensions_of(child)[kInstancesExtension] = shared;
        }
        member(nodes[n], "children", Json::value_t::array).push_back(nodes.size());
        data.model.nodes[n].children.push_back(static_cast<int>(nodes.size()));
        nodes.push_back(std::move(child));
        data.model.nodes.push_back(std::move(model));
    }
    data.expanded.push_back(std::move(expanded));
    return count;
}

} // namespace

void expand_instances(GltfData& data) {
    std::size_t instances = 0;
    double bytes = 0;
    bool found = false, kept = false;
    const std::size_t before = data.model.nodes.size();
    for (std::size_t n = 0; n < before; ++n) {
        if (!extension_of(data.json["nodes"][n], kInstancingExtension))
            continue;
        if (!data.separate.empty() && extension_of(data.json["nodes"][n], kInstancesExtension)) {
            kept = true;
            continue;
        }
        try {
            instances += expand(data, n, bytes);
            found = true;
        } catch (const std::exception& error) { // errors of prtkit and of the JSON library
            throw Error("node " + std::to_string(n) + ": " + in_plain_words(error));
        }
        if (instances > kMaxInstances)
            throw Error("has more than " + std::to_string(kMaxInstances) + " mesh instances");
    }
    if (!found)
        return;
    if (!kept)
        drop_extension(data.json, kInstancingExtension);
    data.notices.push_back(counted(instances, "instance", "instances") + " of EXT_mesh_gpu_instancing " +
                           (instances == 1 ? "becomes a separate node" : "become separate nodes"));
}

} // namespace prt
