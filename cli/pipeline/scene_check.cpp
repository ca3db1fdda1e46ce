// Lists problems that importers and bakes have with a scene.

#include "cli/pipeline/scene_check.h"

#include "bake/gltf/unread.h"
#include "prt/bake/texels.h"
#include "prt/core/error.h"
#include "prt/render/texture.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/printable.h"

#include <fmt/core.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <map>
#include <string_view>
#include <utility>

namespace prt::pipeline {
namespace {

constexpr std::string_view kChecked =
    "notices of the reader, images, extensions, texture coordinates for lightmaps, triangles without area, "
    "closed surfaces that face inwards, lights, number of primitives, vertices changed after a bake";

/// Remedies for notices of reading, by words of these.
constexpr std::pair<std::string_view, std::string_view> kRemedies[] = {
    {"no normals", "export normals; flat normals split every vertex"},
    {"zero or not finite", "recalculate the normals of the mesh"},
    {"no usable normal", "recalculate the normals of the mesh"},
    {"texture coordinate", "unwrap these vertices again"},
    {"cannot be read", "add the file, or bake with --bad-textures ignore"},
    {"' is read", "change the URI to the name of the file"},
    {"normal map", "no action needed: a shader can add it to the baked light"},
    {"skinned", "pose the model before a bake, or use prt lobes"},
    {"morph", "set the weights before a bake"},
    {"EXT_mesh_gpu_instancing", "no action needed, or bake with --instances shared"},
    {"points, lines", "no action needed: they receive no light"},
    {"null", "remove null members from the JSON"},
};

std::string remedy_for(const std::string& notice) {
    for (const auto& [words, remedy] : kRemedies)
        if (notice.find(words) != std::string::npos)
            return std::string(remedy);
    return "no action needed if this is intended";
}

void check_images(const Scene& scene, std::vector<Finding>& findings) {
    for (const auto& [image, encoding] : needed_images(scene, TextureNeeds::all)) {
        const auto index = static_cast<std::size_t>(image);
        if (index >= scene.images.size() || !scene.images[index].trouble.empty())
            continue; // a notice says so
        Scene one;
        one.images = {scene.images[index]};
        Primitive& primitive = one.primitives.emplace_back();
        primitive.material = 0;
        one.materials.emplace_back().base_color_texture.image = 0;
        try {
            load_textures(one, BadTextures::error, TextureNeeds::pictures);
        } catch (const Error&) {
            findings.push_back({scene.images[index].name + " is needed, but cannot be decoded",
                                "store it as PNG or JPEG, or bake with --bad-textures ignore"});
        }
    }
}

/// Missing, overlapping and crossing coordinates of the set that lightmaps use. A model without any such set
/// is meant for vertices.
void check_texcoords(const Scene& scene, std::vector<Finding>& findings) {
    const bool some =
        std::ranges::any_of(scene.vertex_arrays, [](const VertexArray& v) { return v.texcoords.size() > 1; });
    if (!some)
        return;
    try {
        plan_atlases(scene, {.size = 256});
    } catch (const Error& error) {
        findings.push_back({fmt::format("TEXCOORD_1 is not usable for lightmaps: {}", error.what()),
                            "bake lightmaps with --texels N,unwrap; bakes of vertices need no coordinates"});
    }
}

using Corner = std::array<float, 3>;

Corner corner_of(const VertexArray& vertices, std::uint32_t vertex) {
    const glm::vec3& p = vertices.positions[vertex];
    return {p.x, p.y, p.z};
}

/// Volume that the triangles enclose, negative where they face inwards; 0 where an edge is open. m³.
double enclosed_volume(const VertexArray& vertices, const std::vector<glm::uvec3>& triangles) {
    std::map<std::pair<Corner, Corner>, int> open; // edges, counted with their direction
    double volume = 0;
    const glm::dvec3 middle = vertices.positions.empty() ? glm::vec3(0) : vertices.positions[0];
    for (const glm::uvec3& t : triangles) {
        for (int i = 0; i < 3; ++i) {
            const Corner a = corner_of(vertices, t[i]), b = corner_of(vertices, t[(i + 1) % 3]);
            if (a != b)
                open[a < b ? std::pair(a, b) : std::pair(b, a)] += a < b ? 1 : -1;
        }
        const auto at = [&](int i) { return glm::dvec3(vertices.positions[t[i]]) - middle; };
        volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
    }
    const bool closed = std::ranges::all_of(open, [](const auto& edge) { return edge.second == 0; });
    return closed ? volume : 0;
}

void check_triangles(const Scene& scene, std::vector<Finding>& findings) {
    std::size_t flat = 0;
    for (const Primitive& primitive : scene.primitives) {
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        for (const glm::uvec3& t : primitive.triangles) {
            const auto at = [&](int i) { return glm::dvec3(vertices.positions[t[i]]); };
            flat += glm::cross(at(1) - at(0), at(2) - at(0)) == glm::dvec3(0);
        }
        const double volume = enclosed_volume(vertices, primitive.triangles);
        if (volume < 0 && !scene.materials[primitive.material].double_sided)
            findings.push_back(
                {fmt::format("mesh {} primitive {} ({}) is closed and faces inwards: it is invisible from "
                             "outside and receives light on its inside",
                             primitive.mesh, primitive.primitive, printable(primitive.node_name)),
                 "flip its faces, unless it is seen from inside, such as a room"});
    }
    if (flat > 0)
        findings.push_back({counted(flat, "triangle has", "triangles have") + " no area",
                            "remove degenerate faces: their vertices need memory, but are not visible"});
}

void check_lights(const SceneFile& model, std::vector<Finding>& findings) {
    for (const std::string& light : unused_lights(model.document))
        findings.push_back({printable(light) + " is not used by any node", "delete it, or add it to a node"});
    const Bounds box = bounds(model.scene);
    for (const PunctualLight& light : model.scene.lights) {
        const glm::vec3 nearest = glm::clamp(light.position, box.low, box.high);
        if (light.intensity == glm::vec3(0))
            findings.push_back(
                {fmt::format("light '{}' is black", printable(light.name)), "raise its intensity"});
        else if (light.kind != PunctualKind::directional &&
                 glm::distance(nearest, light.position) > light.range)
            findings.push_back({fmt::format("light '{}' has a range of {:.4g} m and reaches no surface",
                                            printable(light.name), light.range),
                                "raise its range, or remove the range"});
    }
}

void check_baked(const SceneFile& model, std::vector<Finding>& findings) {
    const BakeRecord* record = model.record();
    if (!record || model.lightmap || model.instanced || record->receivers.empty() ||
        record->receivers == receivers_id(model.scene))
        return;
    findings.push_back(
        {"its vertices differ from those that were baked: a program has moved or quantised them",
         "run that program before prt bake, or bake again"});
}

} // namespace

std::vector<Finding> check_model(const SceneFile& model) {
    std::vector<Finding> findings;
    const Scene& scene = model.scene;
    for (const std::string& notice : scene.notices)
        findings.push_back({notice, remedy_for(notice)});
    check_images(scene, findings);
    for (const std::string& name : unread_extensions(model.document))
        findings.push_back({"the extension " + printable(name) + " is not read",
                            "no action needed if light does not depend on it: the file keeps it"});
    check_texcoords(scene, findings);
    check_triangles(scene, findings);
    check_lights(model, findings);
    constexpr std::size_t kMany = 10'000;
    if (scene.primitives.size() > kMany)
        findings.push_back(
            {fmt::format("the scene draws {} primitives", scene.primitives.size()),
             "join objects with the same material: each primitive needs draw calls and clusters"});
    check_baked(model, findings);
    return findings;
}

void add_findings(const std::vector<Finding>& findings, Report& report) {
    Json list = Json::array();
    for (std::size_t i = 0; i < findings.size(); ++i) {
        list.push_back({{"problem", findings[i].what}, {"remedy", findings[i].remedy}});
        report.sentences.push_back(fmt::format("check: {{check/findings/{0}/problem}}; "
                                               "{{check/findings/{0}/remedy}}",
                                               i));
    }
    add_figures(report, {{"check", {{"findings", std::move(list)}, {"checked", kChecked}}}});
    report.sentences.push_back(
        fmt::format("check: {}; checked: {{check/checked}}",
                    findings.empty() ? "no problems found" : counted(findings.size(), "problem")));
}

} // namespace prt::pipeline
