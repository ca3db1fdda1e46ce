#pragma once

// The clusters of compressed transfer: means, basis directions, weight storage, and their coded form in
// files. Stable.

#include "prt/coded_rows.h"
#include "prt/transfer_layout.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// Receiver attribute that the vertex shader already has: the unit normal, or the position in metres. Both
/// are in the frame of the bake.
enum class PredictorKind { normal, position };

/// Returns the identifier used in files and reports: "normal" or "position".
const char* to_string(PredictorKind kind);

/// Receiver coordinates that act as weights but are not stored. Transfer in each cluster is first predicted
/// as a linear function of these coordinates; its basis directions then add the residual (docs/math.md, eq.
/// 20).
struct Predictor {
    PredictorKind kind = PredictorKind::normal;
    glm::vec3 origin{0}; ///< 0 for normals; for positions, an offset relative to Scene::origin
    glm::vec3 scale{1};  ///< factor for each coordinate

    bool operator==(const Predictor&) const = default;
};

/// Exponents of two that scale the step of the bases per cluster and group of axes. They are needed because
/// lamp transfer can be a thousand times brighter in one cluster than in another.
struct StepExponents {
    std::vector<int> axes; ///< [groups] number of axes per group; the sum is the number of axes of the bases
    RowCode code;          ///< rows [clusters], columns [groups]

    bool empty() const { return axes.empty(); }
};

/// Coded form of the rows of `ClusteredBases` as sums over a few axes: row = [origin, for means] + sum_i step
/// · scales[i] · value_i · axis_i. Basis directions use twice the step. Values and axes are integers of few
/// bits (docs/format.md).
struct CodedBases {
    std::vector<float> origin; ///< [dimension]
    std::vector<float> scales; ///< [axes]
    float step = 0;
    RowCode axes;   ///< rows [axes], columns [dimension]
    RowCode values; ///< rows as in ClusteredBases, columns [axes]
    /// [dimension] factor of each column of the axes; empty: all 1. Without these factors a lamp that is a
    /// thousand times brighter than the sky would leave no significant digits for the sky.
    std::vector<float> units = {};
    StepExponents exponents = {}; ///< empty: all exponents are 0
};

/// Returns the size of a row code in bytes: `drops` and `bits`.
std::size_t coded_bytes(const RowCode& code);

/// Returns the size of coded bases in bytes: origin, units, scales, axes, exponents and values.
std::size_t coded_bytes(const CodedBases& coded);

/// Decodes the rows of `coded`, [rows][dimension]. Cluster k has one mean, `predictor_rows` predictor rows
/// and `components[k]` basis directions. Throws `Error` if a code is damaged.
std::vector<float> decode_bases(const CodedBases& coded, const std::vector<int>& components,
                                std::size_t predictor_rows = 0);

/// Means, predictor rows and basis directions of all clusters. With x the predictor coordinates of a
/// receiver, T = mean + sum_i (scale_i x_i - center_i) predictor_i + sum_j w_j direction_j.
struct ClusteredBases {
    TransferLayout layout;
    std::vector<Predictor> predictors; ///< empty, or each kind at most once, normals first; the same in all
                                       ///< clusters
    std::vector<int> components;       ///< [clusters] number of basis directions m_k
    /// Per cluster: the mean, three rows per predictor, then m_k basis directions; each row has [dimension]
    /// numbers.
    std::vector<float> rows;
    /// [clusters][predictor_rows()] offset of the scaled predictor coordinates in each cluster, so that the
    /// mean row is the mean of its receivers.
    std::vector<std::int32_t> centers;
    /// Bit widths of weights, 1..16: m_k entries per cluster, cluster after cluster; empty unless weights are
    /// packed.
    std::vector<std::uint8_t> bits;
    /// Coded form from which `rows` was decoded; empty if the file stores `rows` directly.
    CodedBases coded;

    std::size_t clusters() const { return components.size(); }
    std::size_t dimension() const { return layout.dimension(); }
    /// Returns whether `rows` was decoded from `coded`.
    bool is_coded() const { return !coded.origin.empty(); }
    /// Returns the maximum of `components`.
    int max_components() const;
    /// Number of predictor rows per cluster: three per predictor.
    std::size_t predictor_rows() const { return 3 * predictors.size(); }
    /// Number of rows per cluster before its basis directions.
    std::size_t fixed_rows() const { return 1 + predictor_rows(); }
    /// Factor of the i-th predictor coordinate.
    float predictor_scale(std::size_t i) const { return predictors[i / 3].scale[static_cast<int>(i % 3)]; }
    /// Index of the first row of each cluster in `rows`, [clusters + 1]. The bits of cluster k start at
    /// first_row(k) - k fixed_rows().
    std::vector<std::size_t> first_rows() const;
};

/// Location of a cluster's constants, and the layout of its weights: one `uvec4` in the vertex shader's table
/// of clusters. `z` holds the widths of components 0 to 7, `w` those of components 8 to 15.
struct ClusterLayout {
    std::uint32_t first_row = 0;  ///< index of the first constant of the cluster
    std::uint32_t components = 0; ///< m_k
    /// Packed weights: bits - 1 of component j in four bits starting at bit 4 (j mod 8).
    std::uint32_t widths[2] = {};
};

/// Returns whether all clusters have the same number of components and, if packed, the same weight widths.
/// The vertex shader then needs no table and no loop.
bool clusters_have_equal_layout(const ClusteredBases& bases);

/// Maximum number of packed weights per receiver.
inline constexpr int kMaxPackedComponents = 16;

/// Returns the constants and weight layout of each cluster, [clusters].
std::vector<ClusterLayout> cluster_layouts(const ClusteredBases& bases);

/// Number of bytes that a game needs for the bases: rows or their code, and the weight layout.
std::size_t basis_bytes(const ClusteredBases& bases);

} // namespace prt
