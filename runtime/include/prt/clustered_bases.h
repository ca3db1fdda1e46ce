#pragma once

// The clusters of compressed transfer: means, directions, how their weights are stored, and the code of a
// file. Stable.

#include "prt/coded_rows.h"
#include "prt/transfer_layout.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// What is known of a receiver wherever its transfer is rebuilt: its unit normal, or its position in metres,
/// both in the frame of the bake.
enum class GuideKind { normal, position };

const char* to_string(GuideKind kind);

/// Coordinates that serve as weights and are stored nowhere: every cluster is a linear function of them
/// before its directions add what they do not tell (docs/math.md, eq. 20).
struct Guide {
    GuideKind kind = GuideKind::normal;
    glm::vec3 origin{0}; ///< 0 for normals; positions are seen from here, which is seen from Scene::origin
    glm::vec3 scale{1};  ///< a row counts so often for each unit of its coordinate

    bool operator==(const Guide&) const = default;
};

/// Powers of two that the step of bases has in each cluster and group of axes: light of a lamp is a thousand
/// times as bright in one cluster as in another.
struct StepExponents {
    std::vector<int> axes; ///< [groups] axes of each group; all together those of the bases
    RowCode code;          ///< rows [clusters], columns [groups]

    bool empty() const { return axes.empty(); }
};

/// Rows as sums over a few axes: row = [origin, for means] + sum_i step · scales[i] · value_i · axis_i, with
/// twice the step for directions. Values and axes are integers of few bits (docs/format.md).
struct CodedBases {
    std::vector<float> origin; ///< [dimension]
    std::vector<float> scales; ///< [axes]
    float step = 0;
    RowCode axes;   ///< rows [axes], columns [dimension]
    RowCode values; ///< rows as in ClusteredBases, columns [axes]
    /// [dimension]: what the axes' numbers are multiplied with in each column; empty: 1. A lamp that is a
    /// thousand times as bright as a sky would leave it no digits otherwise.
    std::vector<float> units = {};
    StepExponents exponents = {}; ///< empty: all 0
};

/// Bytes of drops and bits.
std::size_t coded_bytes(const RowCode& code);

/// Bytes of origin, units, scales, axes, exponents and values.
std::size_t coded_bytes(const CodedBases& coded);

/// The rows that `coded` stands for, [rows][dimension]; cluster k has one mean, `guide_rows` of guides and
/// `components[k]` directions. Throws `Error` where a code is damaged.
std::vector<float> decode_bases(const CodedBases& coded, const std::vector<int>& components,
                                std::size_t guide_rows = 0);

/// Means, rows of guides and directions of all clusters: with x the coordinates of a receiver's guides,
/// T = mean + sum_i (scale_i x_i - center_i) guide_i + sum_j w_j direction_j.
struct ClusteredBases {
    TransferLayout layout;
    std::vector<Guide> guides;   ///< none, or each kind once at most, normals first; the same in all clusters
    std::vector<int> components; ///< [clusters] number of directions m_k
    /// Per cluster its mean, three rows for each guide, then its m_k directions; each [dimension].
    std::vector<float> rows;
    /// [clusters][guide_rows()]: where a cluster is, so that its mean is that of its receivers.
    std::vector<std::int32_t> centers;
    /// Per cluster the bits of its m_k weights, 1..16; empty unless weights are packed.
    std::vector<std::uint8_t> bits;
    /// What `rows` was decoded from; without axes where the file holds `rows` themselves.
    CodedBases coded;

    std::size_t clusters() const { return components.size(); }
    std::size_t dimension() const { return layout.dimension(); }
    bool is_coded() const { return !coded.origin.empty(); }
    int max_components() const;
    std::size_t guide_rows() const { return 3 * guides.size(); }
    /// Rows of a cluster that are no directions.
    std::size_t fixed_rows() const { return 1 + guide_rows(); }
    /// The factor of row i of the guides.
    float guide_scale(std::size_t i) const { return guides[i / 3].scale[static_cast<int>(i % 3)]; }
    /// Index of the first row of cluster `cluster` in `rows`; its bits start at first_row(k) - k
    /// fixed_rows(). [clusters + 1]
    std::vector<std::size_t> first_rows() const;
};

/// Where the vertex shader finds a cluster: `uvec4` of its table. Components 8 and up have their widths in
/// `w`.
struct ClusterLayout {
    std::uint32_t first_row = 0;  ///< of its constants
    std::uint32_t components = 0; ///< m_k
    std::uint32_t widths[2] =
        {}; ///< of packed weights: bits - 1 of component j in four bits from 4 (j mod 8) on
};

/// Whether all clusters have as many components, and packed weights the same bits: a vertex shader wants no
/// table then, and no loop.
bool clusters_are_alike(const ClusteredBases& bases);

inline constexpr int kMostPackedComponents = 16;

/// The table [clusters].
std::vector<ClusterLayout> cluster_layouts(const ClusteredBases& bases);

/// Bytes that a game needs of the bases: rows or their code, and the layout of the weights.
std::size_t basis_bytes(const ClusteredBases& bases);

} // namespace prt
