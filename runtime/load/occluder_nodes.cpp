// Reads occlusion volumes of nodes: PRTKIT_occlusion_volume of docs/format.md.
#include "runtime/load/occluder_nodes.h"

#include "prt/core/error.h"
#include "runtime/load/accessor.h"
#include "runtime/load/extensions.h"

#include <cstring>
#include <string>

namespace prt {
namespace {

glm::vec3 read_corner(const Json& json, const char* name) {
    const Json& corner = json.at(name);
    if (!corner.is_array() || corner.size() != 3)
        throw Error(std::string(name) + " of an occlusion volume is not a list of three numbers");
    return {corner[0].get<float>(), corner[1].get<float>(), corner[2].get<float>()};
}

OcclusionVolume read_occluder(const GltfData& data, const Json& json) {
    const Json version = json.value("version", Json(0));
    if (!version.is_number_integer() || version != kOccluderVersion)
        throw Error(std::string(kOccluderExtension) + " has version " + version.dump() +
                    ", but this program reads version " + std::to_string(kOccluderVersion) +
                    "; write the file again with this version of prt");
    OcclusionVolume volume;
    volume.low = read_corner(json, "min");
    volume.high = read_corner(json, "max");
    volume.reach = json.at("reach").get<float>();
    check_occlusion_volume(volume);
    const auto bytes = buffer_view_bytes(data.model, json.at("texels").at("bufferView").get<int>());
    if (bytes.size() != sizeof volume.texels)
        throw Error("an occlusion volume has " + std::to_string(bytes.size()) +
                    " bytes of texels, but must have " + std::to_string(sizeof volume.texels));
    std::memcpy(volume.texels.data(), bytes.data(), bytes.size());
    return volume;
}

} // namespace

std::vector<NodeOccluder> read_occluders(const GltfData& data) {
    std::vector<NodeOccluder> occluders;
    if (!data.json.contains("nodes"))
        return occluders;
    const Json& nodes = data.json["nodes"];
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (const Json* extension = extension_of(nodes[n], kOccluderExtension)) {
            try {
                occluders.push_back({static_cast<int>(n), read_occluder(data, *extension)});
            } catch (const std::exception& error) {
                throw Error("node " + std::to_string(n) + ": " + in_plain_words(error));
            }
        }
    return occluders;
}

} // namespace prt
