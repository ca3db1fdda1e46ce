// Bases of clusters: layout, sizes, and decoding of their rows.
#include "prt/core/clustered_bases.h"

#include "prt/core/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace prt {

const char* to_string(PredictorKind kind) {
    return kind == PredictorKind::normal ? "normal" : "position";
}

int ClusteredBases::max_components() const {
    return components.empty() ? 0 : *std::max_element(components.begin(), components.end());
}

std::vector<std::size_t> ClusteredBases::first_rows() const {
    std::vector<std::size_t> first(clusters() + 1, 0);
    for (std::size_t k = 0; k < clusters(); ++k)
        first[k + 1] = first[k] + fixed_rows() + static_cast<std::size_t>(components[k]);
    return first;
}

std::size_t coded_bytes(const RowCode& code) {
    return code.drops.size() + code.bits.size();
}

std::size_t coded_bytes(const CodedBases& coded) {
    return (coded.origin.size() + coded.units.size() + coded.scales.size() + 1) * sizeof(float) +
           coded_bytes(coded.axes) + coded_bytes(coded.values) + coded.exponents.axes.size() +
           coded_bytes(coded.exponents.code);
}

namespace {

/// Returns the step of each axis in each cluster times its scale, [clusters][axes].
std::vector<float> steps_of(const CodedBases& coded, std::size_t clusters) {
    const std::size_t axes = coded.scales.size(), groups = coded.exponents.axes.size();
    std::vector<std::size_t> group_of;
    for (std::size_t g = 0; g < groups; ++g)
        for (int i = 0; i < coded.exponents.axes[g] && group_of.size() <= axes; ++i)
            group_of.push_back(g);
    if (groups > 0 && (group_of.size() != axes || coded.exponents.code.drops.size() != groups))
        throw Error("the steps of the bases do not match the number of axes");
    std::vector<std::int32_t> exponents;
    if (groups > 0)
        exponents = decode_rows(coded.exponents.code, clusters);
    std::vector<float> steps;
    for (std::size_t k = 0; k < clusters; ++k)
        for (std::size_t i = 0; i < axes; ++i)
            steps.push_back(std::ldexp(coded.step * coded.scales[i],
                                       groups > 0 ? exponents[k * groups + group_of[i]] : 0));
    return steps;
}

} // namespace

std::vector<float> decode_bases(const CodedBases& coded, const std::vector<int>& components,
                                std::size_t predictor_rows) {
    const std::size_t axes = coded.scales.size(), dimension = coded.origin.size();
    if (coded.axes.drops.size() != dimension || coded.values.drops.size() != axes ||
        (!coded.units.empty() && coded.units.size() != dimension))
        throw Error("the code of the bases has the wrong number of columns");
    std::size_t rows = 0;
    for (const int m : components)
        rows += 1 + predictor_rows + static_cast<std::size_t>(m);
    const std::vector<std::int32_t> axis_values = decode_rows(coded.axes, axes),
                                    values = decode_rows(coded.values, rows);
    std::vector<float> result(rows * dimension, 0.0f);
    const std::vector<float> steps = steps_of(coded, components.size());
    std::size_t row = 0, cluster = 0;
    for (const int m : components) {
        const float* step = steps.data() + cluster++ * axes;
        for (std::size_t j = 0; j <= predictor_rows + static_cast<std::size_t>(m); ++j, ++row) {
            float* to = &result[row * dimension];
            const float factor = j <= predictor_rows ? 1.0f : 2.0f;
            for (std::size_t i = 0; i < axes; ++i) {
                const float y = factor * step[i] * static_cast<float>(values[row * axes + i]);
                for (std::size_t a = 0; y != 0 && a < dimension; ++a)
                    to[a] += y * static_cast<float>(axis_values[i * dimension + a]);
            }
            for (std::size_t a = 0; a < coded.units.size(); ++a)
                to[a] *= coded.units[a];
            for (std::size_t a = 0; j == 0 && a < dimension; ++a)
                to[a] += coded.origin[a];
        }
    }
    return result;
}

std::vector<ClusterLayout> cluster_layouts(const ClusteredBases& bases) {
    const std::vector<std::size_t> first = bases.first_rows();
    std::vector<ClusterLayout> layouts(bases.clusters());
    for (std::size_t k = 0; k < bases.clusters(); ++k) {
        ClusterLayout& layout = layouts[k];
        layout.first_row = static_cast<std::uint32_t>(first[k]);
        layout.components = static_cast<std::uint32_t>(bases.components[k]);
        if (bases.bits.empty())
            continue;
        assert(bases.components[k] <= kMaxPackedComponents);
        for (std::size_t j = 0; j < layout.components; ++j)
            layout.widths[j / 8] |=
                static_cast<std::uint32_t>(bases.bits[first[k] - k * bases.fixed_rows() + j] - 1)
                << (4 * (j % 8));
    }
    return layouts;
}

bool clusters_have_equal_layout(const ClusteredBases& bases) {
    if (bases.components.empty())
        return false;
    const int components = bases.components.front();
    return std::ranges::all_of(bases.components, [&](int m) { return m == components; }) &&
           (bases.bits.empty() ||
            std::equal(bases.bits.begin() + components, bases.bits.end(), bases.bits.begin()));
}

std::size_t basis_bytes(const ClusteredBases& bases) {
    // One byte for each m_k, four bits for the width of each packed weight.
    const std::size_t layout = bases.clusters() + (bases.bits.size() + 1) / 2;
    const std::size_t predictors = bases.predictors.empty()
                                       ? 0
                                       : bases.predictors.size() * sizeof(Predictor) +
                                             coded_bytes(encode_rows(bases.centers, bases.predictor_rows()));
    return layout + predictors +
           (bases.is_coded() ? coded_bytes(bases.coded) : bases.rows.size() * sizeof(float));
}

} // namespace prt
