// Reads predictors and offsets of compressed transfer in glTF files.
#include "runtime/load/predictors_json.h"

#include "runtime/load/allowance.h"
#include "runtime/load/predictors.h"

#include <cmath>

namespace prt {
namespace {

PredictorKind read_predictor_kind(const Json& json) {
    if (json.is_string())
        for (const PredictorKind kind : {PredictorKind::normal, PredictorKind::position})
            if (json == to_string(kind))
                return kind;
    throw Error("the kind of a predictor is unknown; it must be normal or position");
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
        throw Error(name + " of a predictor must be three numbers with absolute values of at most " +
                    std::to_string(static_cast<long long>(largest)));
    return numbers;
}

Predictor read_predictor(const Json& json, const glm::dvec3& scene_origin) {
    Predictor predictor{read_predictor_kind(json.at("kind"))};
    predictor.scale = glm::vec3(read_three(json.at("scale"), "scale", static_cast<double>(kMaxFloatWeight)));
    for (int i = 0; i < 3; ++i)
        if (predictor.scale[i] == 0)
            throw Error("the scale of a predictor is 0, or too small for a float");
    if (predictor.kind == PredictorKind::position)
        predictor.origin = glm::vec3(read_three(json.at("origin"), "origin", kFarthestVertex) - scene_origin);
    return predictor;
}

std::vector<std::int32_t> read_centers(const GltfData& data, const Json& json, const ClusteredBases& bases) {
    const RowCode code = read_row_code(data, json);
    if (code.drops.size() != bases.predictor_rows())
        throw Error("the centers have " + std::to_string(code.drops.size()) +
                    " columns, but the predictors have " + std::to_string(bases.predictor_rows()) + " rows");
    try {
        return decode_rows(code, bases.clusters());
    } catch (const Error& error) {
        throw Error(std::string("the centers: ") + error.what());
    }
}

} // namespace

void read_predictors(const GltfData& data, const Scene& scene, const Json& extension, ClusteredBases& bases) {
    if (!extension.contains("predictors"))
        return;
    const Json& predictors = extension["predictors"];
    if (!predictors.is_array() || predictors.empty() || predictors.size() > 2)
        throw Error("the predictors are not a list of one or two elements");
    for (const Json& predictor : predictors)
        bases.predictors.push_back(read_predictor(predictor, scene.origin));
    if (bases.predictors.size() == 2 && (bases.predictors[0].kind != PredictorKind::normal ||
                                         bases.predictors[1].kind != PredictorKind::position))
        throw Error("two predictors must be a normal and a position, in this order");
    bases.centers = read_centers(data, extension.at("centers"), bases);
}

std::vector<float> read_coordinates(const GltfData& data, const Scene& scene, const ClusteredBases& bases) {
    if (bases.predictors.empty())
        return {};
    check_allowed(static_cast<double>(scene.receivers()) * static_cast<double>(bases.predictor_rows()) *
                      sizeof(float),
                  data.file_bytes, "the coordinates of its predictors");
    return predictor_coordinates(scene, bases.predictors);
}

} // namespace prt
