// Adds random predictors to transfer.

#include "support/predicted.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace prt::test {

const std::vector<std::vector<PredictorKind>>& sets_of_predictors() {
    static const std::vector<std::vector<PredictorKind>> sets = {
        {},
        {PredictorKind::normal},
        {PredictorKind::position},
        {PredictorKind::normal, PredictorKind::position}};
    return sets;
}

void add_predictors(ClusteredBases& bases, const std::vector<PredictorKind>& kinds, std::mt19937& random) {
    std::normal_distribution<float> normal;
    const std::vector<std::size_t> first = bases.first_rows();
    const std::size_t dimension = bases.dimension(), predictors = 3 * kinds.size();
    std::vector<float> rows;
    for (std::size_t k = 0; k < bases.clusters(); ++k) {
        const auto mean = bases.rows.begin() + static_cast<std::ptrdiff_t>(first[k] * dimension);
        const auto direction = mean + static_cast<std::ptrdiff_t>(dimension);
        rows.insert(rows.end(), mean, direction);
        for (std::size_t i = 0; i < predictors * dimension; ++i)
            rows.push_back(0.3f * normal(random));
        rows.insert(rows.end(), direction,
                    bases.rows.begin() + static_cast<std::ptrdiff_t>(first[k + 1] * dimension));
        for (std::size_t g = 0; g < predictors; ++g)
            bases.centers.push_back(static_cast<std::int32_t>(random() % 7) - 3);
    }
    bases.rows = rows;
    bases.coded = {};
    for (const PredictorKind kind : kinds) {
        Predictor predictor{kind, glm::vec3(0), glm::vec3(2, 0.5f, 1.25f)};
        if (kind == PredictorKind::position)
            predictor.origin = glm::vec3(0.25f, -2, 1.3f);
        bases.predictors.push_back(predictor);
    }
}

void add_predictors(ClusteredTransfer& transfer, const std::vector<PredictorKind>& kinds,
                    std::mt19937& random) {
    add_predictors(transfer.bases, kinds, random);
    std::normal_distribution<float> normal;
    for (std::size_t p = 0; p < transfer.receivers.size(); ++p)
        for (const Predictor& predictor : transfer.bases.predictors) {
            glm::vec3 x(normal(random), normal(random), normal(random));
            if (predictor.kind == PredictorKind::normal) {
                x = glm::normalize(x);
                if (p % 3 == 1)
                    x = glm::normalize(glm::round(127.0f * x));
                if (p % 7 == 0)
                    x = glm::vec3(0);
            }
            transfer.receivers.predictors.insert(transfer.receivers.predictors.end(), {x.x, x.y, x.z});
        }
}

void code_bases(ClusteredBases& bases, const std::vector<float>& scales, std::mt19937& random) {
    const auto integers = [&](std::size_t count) {
        std::vector<std::int32_t> values(count);
        for (std::int32_t& value : values)
            value = static_cast<std::int32_t>(random() % 201) - 100;
        return values;
    };
    CodedBases& coded = bases.coded;
    coded.origin.assign(bases.dimension(), 0.5f);
    coded.scales = scales;
    coded.step = 0.01f;
    coded.units.assign(bases.dimension(), 1);
    coded.units.back() = 4;
    coded.axes = encode_rows(integers(scales.size() * bases.dimension()), bases.dimension());
    coded.values = encode_rows(integers(bases.first_rows().back() * scales.size()), scales.size());
    const auto axes = static_cast<int>(scales.size());
    coded.exponents.axes = {1, axes - 1};
    std::vector<std::int32_t> exponents(2 * bases.clusters());
    for (std::int32_t& exponent : exponents)
        exponent = static_cast<std::int32_t>(random() % 4);
    coded.exponents.code = encode_rows(exponents, 2);
    bases.rows = decode_bases(coded, bases.components, bases.predictor_rows());
}

std::vector<double> decoded_by_hand(const ClusteredTransfer& transfer, std::size_t p) {
    const ClusteredBases& bases = transfer.bases;
    const std::size_t k = transfer.receivers.cluster(p), dimension = bases.dimension(),
                      predictors = bases.predictor_rows();
    std::vector<float> weights(static_cast<std::size_t>(bases.max_components()));
    decode_weights(transfer, cluster_layouts(bases), p, weights);
    std::vector<double> factors = {1};
    for (std::size_t g = 0; g < predictors; ++g)
        factors.push_back(static_cast<double>(bases.predictors[g / 3].scale[static_cast<int>(g % 3)]) *
                              static_cast<double>(transfer.receivers.predictors[p * predictors + g]) -
                          bases.centers[k * predictors + g]);
    for (int j = 0; j < bases.components[k]; ++j)
        factors.push_back(static_cast<double>(weights[static_cast<std::size_t>(j)]));
    std::size_t first = 0;
    for (std::size_t before = 0; before < k; ++before)
        first += 1 + predictors + static_cast<std::size_t>(bases.components[before]);
    std::vector<double> vector(dimension, 0);
    for (std::size_t j = 0; j < factors.size(); ++j)
        for (std::size_t i = 0; i < dimension; ++i)
            vector[i] += factors[j] * static_cast<double>(bases.rows[(first + j) * dimension + i]);
    return vector;
}

} // namespace prt::test
