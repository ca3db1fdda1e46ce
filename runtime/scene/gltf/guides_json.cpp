// Reads and writes predictors and offsets of compressed transfer in glTF files.
#include "gltf/guides_json.h"

#include "gltf/allowance.h"
#include "prt/guides.h"

#include <cmath>

namespace prt {
namespace {

GuideKind read_guide_kind(const Json& json) {
    if (json.is_string())
        for (const GuideKind kind : {GuideKind::normal, GuideKind::position})
            if (json == to_string(kind))
                return kind;
    throw Error("a guide is of a kind that this program does not know");
}

/// Reads three finite numbers with magnitudes of at most `largest`.
glm::dvec3 read_three(const Json& json, const std::string& name, double largest) {
    glm::dvec3 numbers(0);
    bool good = json.is_array() && json.size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
        good = json[i].is_number();
        if (good)
            numbers[static_cast<int>(i)] = json[i].get<double>();
        good = good && std::abs(numbers[static_cast<int>(i)]) <= largest; // false for NaN
    }
    if (!good)
        throw Error(name + " of a guide is not three numbers of at most " +
                    std::to_string(static_cast<long long>(largest)));
    return numbers;
}

Guide read_guide(const Json& json, const glm::dvec3& scene_origin) {
    Guide guide{read_guide_kind(json.at("kind"))};
    guide.scale = glm::vec3(read_three(json.at("scale"), "scale", static_cast<double>(kMaxFloatWeight)));
    for (int i = 0; i < 3; ++i)
        if (guide.scale[i] == 0)
            throw Error("scale of a guide is zero, or too small for a float");
    if (guide.kind == GuideKind::position)
        guide.origin = glm::vec3(read_three(json.at("origin"), "origin", kFarthestVertex) - scene_origin);
    return guide;
}

std::vector<std::int32_t> read_centers(const GltfContents& contents, const Json& json,
                                       const ClusteredBases& bases) {
    const RowCode code = read_row_code(contents, json);
    if (code.drops.size() != bases.guide_rows())
        throw Error("the centers have " + std::to_string(code.drops.size()) + " columns for " +
                    std::to_string(bases.guide_rows()) + " rows of guides");
    try {
        return decode_rows(code, bases.clusters());
    } catch (const Error& error) {
        throw Error(std::string("the centers: ") + error.what());
    }
}

} // namespace

void write_guides(GltfContents& contents, const Scene& scene, const ClusteredBases& bases, Json& extension) {
    if (bases.guides.empty())
        return;
    Json guides = Json::array();
    for (const Guide& guide : bases.guides) {
        Json json = {{"kind", to_string(guide.kind)}};
        if (guide.kind == GuideKind::position) {
            const glm::dvec3 origin = scene.world(guide.origin);
            json["origin"] = {origin.x, origin.y, origin.z};
        }
        json["scale"] = {guide.scale.x, guide.scale.y, guide.scale.z};
        guides.push_back(std::move(json));
    }
    extension["guides"] = std::move(guides);
    extension["centers"] = write_row_code(contents, encode_rows(bases.centers, bases.guide_rows()));
}

void read_guides(const GltfContents& contents, const Scene& scene, const Json& extension,
                 ClusteredBases& bases) {
    if (!extension.contains("guides"))
        return;
    const Json& guides = extension["guides"];
    if (!guides.is_array() || guides.empty() || guides.size() > 2)
        throw Error("guides are no list of one or two");
    for (const Json& guide : guides)
        bases.guides.push_back(read_guide(guide, scene.origin));
    if (bases.guides.size() == 2 &&
        (bases.guides[0].kind != GuideKind::normal || bases.guides[1].kind != GuideKind::position))
        throw Error("two guides are a normal and then a position");
    bases.centers = read_centers(contents, extension.at("centers"), bases);
}

std::vector<float> read_coordinates(const GltfContents& contents, const Scene& scene,
                                    const ClusteredBases& bases) {
    if (bases.guides.empty())
        return {};
    check_allowed(static_cast<double>(scene.receivers()) * static_cast<double>(bases.guide_rows()) *
                      sizeof(float),
                  contents.file_bytes, "the coordinates of its guides");
    std::vector<float> coordinates = guide_coordinates(scene, bases.guides);
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        if (!(std::abs(coordinates[i] * bases.guide_scale(i % bases.guide_rows())) <= kMaxFloatWeight))
            throw Error("a vertex is farther from the origin of a guide than its scale allows");
    return coordinates;
}

} // namespace prt
