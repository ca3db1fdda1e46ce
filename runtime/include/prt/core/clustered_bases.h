#pragma once

// The clusters of compressed transfer: their rows (means, predictor rows, basis directions), the bit widths
// of their weights, and the coded form of the rows in files. Stable.

#include "prt/core/transfer_layout.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Entropy code of a matrix of integers, [rows][columns]; the caller stores the number of rows. Each row
/// starts with its level, an integer in 0..15. In a row of level t, the value of column i fits max(0, t -
/// drops[i]) bits in two's complement; this number is the width of the value, and a value of width 0 is 0. A
/// large drop makes the values of a column cheap in every row, and limits their size.
struct RowCode {
    std::vector<std::uint8_t>
        drops; ///< [columns] number of bits by which column i is narrower than the level, 0..15
    std::vector<std::byte> bits; ///< levels and values of all rows in one arithmetic code
};

/// Maximum width of a coded value in bits: values are in -16384..16383.
inline constexpr int kMaxRowBits = 15;

/// Returns a code of `values` [rows][columns], which must be in -16384..16383. The number of rows is
/// values.size() / columns. The code is short, but the search for the best drops is not exhaustive.
RowCode encode_rows(std::span<const std::int32_t> values, std::size_t columns);

/// Returns the values of a code of `rows` rows, [rows][code.drops.size()]. Throws `Error` if `code.bits` is
/// too short for that number of rows. Does not detect other damage: the values of a damaged code can exceed
/// the width of their column.
std::vector<std::int32_t> decode_rows(const RowCode& code, std::size_t rows);

/// Receiver attribute that a predictor uses, because the vertex shader already has it: the unit normal, or
/// the position in metres. Both are in the frame in which the model was baked: axes of the scene, positions
/// relative to Scene::origin.
enum class PredictorKind { normal, position };

/// Returns the identifier used in files and reports: "normal" or "position".
const char* to_string(PredictorKind kind);

/// Three receiver coordinates that act as weights but are not stored. They predict the transfer of each
/// cluster as a linear function; the basis directions of the cluster add the residual (docs/math.md, eq. 20).
/// The predictor coordinates are x = attribute - `origin`; formulas multiply x by `scale`.
struct Predictor {
    PredictorKind kind = PredictorKind::normal; ///< attribute that has the coordinates
    glm::vec3 origin{0}; ///< normal: 0; position: a point in metres, relative to Scene::origin
    glm::vec3 scale{1};  ///< factor of each coordinate, not 0; position: per metre

    bool operator==(const Predictor&) const = default;
};

/// Factors of the step of coded bases: for axes of group g, cluster k uses the step times two to the power of
/// e[k][g]. Lamps need them, because their transfer can be a thousand times brighter in one cluster than in
/// another. A group consists of consecutive axes of `CodedBases`.
struct StepExponents {
    std::vector<int> axes; ///< [groups] number of axes in each group; the sum is the number of all axes
    RowCode code;          ///< integers e: rows [clusters], columns [groups]

    /// Returns whether there are no groups; all factors are then 1.
    bool empty() const { return axes.empty(); }
};

/// Coded form of `ClusteredBases::rows` (docs/format.md). Each row is a sum over a few axes, vectors of
/// integers that all clusters share: row = units · sum_i step · scales[i] · values[i] · axes[i], by
/// coefficient. Basis directions use twice the step. `origin` is added to means, after the factors `units`.
/// `exponents` change the step. dimension = `TransferLayout::dimension`.
struct CodedBases {
    std::vector<float> origin; ///< [dimension]; empty: there is no coded form
    std::vector<float> scales; ///< [axes] factor of each axis
    float step = 0;            ///< unit of the integers in `values`
    RowCode axes;              ///< integers of the axes: rows [axes], columns [dimension]
    RowCode values;            ///< integers: one row per row of ClusteredBases, columns [axes]
    /// [dimension] factor of each coefficient; empty: all 1. Without these factors a lamp that is a thousand
    /// times brighter than the sky would leave no significant digits for the sky.
    std::vector<float> units = {};
    StepExponents exponents = {}; ///< factors of the step by cluster; empty: all 1
};

/// Returns the size of `code` in bytes: that of `RowCode::drops` plus that of `RowCode::bits`.
std::size_t coded_bytes(const RowCode& code);

/// Returns the size of all members of `coded` in bytes: four for each float, one for each entry of
/// `StepExponents::axes`, and the `coded_bytes` of each code.
std::size_t coded_bytes(const CodedBases& coded);

/// Decodes the rows of `coded`, in the order of `ClusteredBases::rows`: [rows][dimension]. Cluster k has one
/// mean, `predictor_rows` predictor rows and `components[k]` basis directions; `components` is [clusters].
/// Throws `Error` if a code ends too early, or if the lengths of the members of `coded` do not match: the
/// numbers of columns of the codes, the length of `units`, or the sum of `StepExponents::axes`.
std::vector<float> decode_bases(const CodedBases& coded, const std::vector<int>& components,
                                std::size_t predictor_rows = 0);

/// Means, predictor rows and basis directions of all clusters. The transfer vector of a receiver is T = mean
/// + sum_i (scale_i x_i - center_i) predictor_i + sum_j w_j direction_j, with the rows of the receiver's
/// cluster, the predictor coordinates x of the receiver (see `Predictor`) and its weights w.
struct ClusteredBases {
    TransferLayout layout; ///< layout of the rows and of the transfer vectors
    /// Predictors of all clusters: each kind at most once, normals first; empty: no predictors.
    std::vector<Predictor> predictors;
    std::vector<int> components; ///< [clusters] number m_k of basis directions of cluster k; may be 0
    /// [number of rows][dimension()]. For each cluster k in turn: the mean, three rows per predictor, then
    /// m_k basis directions.
    std::vector<float> rows;
    /// [clusters][predictor_rows()] center_i of each cluster: the scaled predictor coordinates scale_i x_i at
    /// which the mean applies, rounded to integers.
    std::vector<std::int32_t> centers;
    /// [sum of m_k] number of bits of each weight, 1..16, cluster after cluster. Empty if weights are
    /// float32.
    std::vector<std::uint8_t> bits;
    /// Coded form from which `rows` was decoded; without content if the file stores `rows` as float32
    /// (`is_coded`).
    CodedBases coded;

    /// Returns the number of clusters.
    std::size_t clusters() const { return components.size(); }
    /// Returns the number of coefficients of a row or transfer vector, over all outputs.
    std::size_t dimension() const { return layout.dimension(); }
    /// Returns whether `rows` was decoded from `coded`.
    bool is_coded() const { return !coded.origin.empty(); }
    /// Returns the maximum of `components`; 0 without clusters.
    int max_components() const;
    /// Returns the number of predictor rows of each cluster: three per predictor.
    std::size_t predictor_rows() const { return 3 * predictors.size(); }
    /// Returns the number of rows of each cluster before its basis directions: mean and predictor rows.
    std::size_t fixed_rows() const { return 1 + predictor_rows(); }
    /// Returns scale_i, the factor of predictor coordinate i, 0 .. predictor_rows() - 1.
    float predictor_scale(std::size_t i) const { return predictors[i / 3].scale[static_cast<int>(i % 3)]; }
    /// Returns the row index of the mean of each cluster, [clusters() + 1]; the last element is the number of
    /// all rows. The numbers of row r start at rows[r * dimension()]. The entries of cluster k in `bits`
    /// start at bits[first_rows()[k] - k * fixed_rows()].
    std::vector<std::size_t> first_rows() const;
};

/// Location of the constants of a cluster, and the layout of its weights. The table of clusters of the vertex
/// shader stores it as one `uvec4`: first_row, components, widths[0], widths[1].
struct ClusterLayout {
    /// Index of the first row of the cluster (`ClusteredBases::first_rows`). With one output this is the
    /// index of its first constant; with several, multiply by the number of outputs.
    std::uint32_t first_row = 0;
    std::uint32_t components = 0; ///< number m_k of weights of a receiver of this cluster
    /// Packed weights: number of bits of weight j minus 1, in the four bits of widths[j / 8] that start at
    /// bit 4 (j mod 8). Float weights: 0.
    std::uint32_t widths[2] = {};
};

/// Returns whether all clusters have the same number of components and, if weights are packed, the same bits
/// of each weight. The vertex shader then needs no table of clusters and no loop. Returns false without
/// clusters.
bool clusters_have_equal_layout(const ClusteredBases& bases);

/// Maximum number of packed weights per receiver, which is the maximum of m_k for packed weights.
inline constexpr int kMaxPackedComponents = 16;

/// Returns the location of the constants and the layout of the weights of each cluster, [clusters].
std::vector<ClusterLayout> cluster_layouts(const ClusteredBases& bases);

/// Returns the size of the bases in bytes, for comparisons of sizes: of the coded rows, or of float32 rows if
/// there is no coded form; plus predictors with their centers; plus number and bits of weights per cluster.
std::size_t basis_bytes(const ClusteredBases& bases);

} // namespace prt
