// Converts clusters to their form in a file: row length is the extent of a weight of 1, on a grid of values.
// The range of the uniform quantiser is chosen as for a Gaussian (Max 1960), but by trial on the points
// themselves.

#include "compress/coding/quantised_clusters.h"

namespace prt {
namespace {

/// Returns the length of a row along a principal axis for which rounding the coordinates `along` loses least.
double best_length(std::span<const double> along, std::span<const double> significance, float steps) {
    double largest = 0;
    for (const double a : along)
        largest = std::max(largest, std::abs(a));
    double best = largest, least = std::numeric_limits<double>::infinity();
    for (int tenths = tuning::kMaxLengthTenths; tenths >= tuning::kMinLengthTenths; --tenths) {
        const double length = tenths / 10.0 * largest, h = static_cast<double>(steps);
        double error = 0;
        for (std::size_t p = 0; p < along.size(); ++p) {
            const double w = std::clamp(length > 0 ? along[p] / length : 0.0, -1.0, 1.0);
            const double lost = along[p] - length * (std::round((w + 1) * h) / h - 1);
            error += significance[p] * lost * lost;
        }
        if (error < least) {
            least = error;
            best = length;
        }
    }
    return best;
}

/// Coordinates of a cluster's members along its directions.
struct MemberCoordinates {
    std::vector<double> along; ///< [directions][members]
    std::vector<double> significance;
};

MemberCoordinates coordinates_of(const PointBlocks& points, std::span<const float> significance,
                                 const AffineClusters& clusters, std::size_t k,
                                 std::span<const std::uint32_t> members) {
    const std::size_t count = clusters.components_of(k), n = members.size();
    MemberCoordinates result{std::vector<double>(count * n, 0), {}};
    std::vector<float> point(points.width());
    for (std::size_t r = 0; r < n; ++r) {
        points.copy_point(members[r], point.data());
        subtract_known(clusters, k, point.data());
        result.significance.push_back(static_cast<double>(significance[members[r]]));
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t i = 0; i < points.dimension; ++i)
                result.along[j * n + r] +=
                    static_cast<double>(clusters.row(k, j)[i]) * static_cast<double>(point[i]);
    }
    return result;
}

} // namespace

ClusterLists members_of(std::span<const std::uint32_t> clusters, std::size_t count) {
    ClusterLists members(count);
    for (std::uint32_t p = 0; p < clusters.size(); ++p)
        members[clusters[p]].push_back(p);
    return members;
}

QuantisedClusters quantised_clusters(const PointBlocks& points, std::span<const float> significance,
                                     const Clustering& clustering, WeightFormat format, int threads) {
    const std::vector<ClusterFit>& fits = clustering.fits;
    QuantisedClusters result{penalised_clusters(fits, points.dimension), {}};
    result.grids.resize(fits.size() * result.max_components, WeightGrid::any());
    if (format == WeightFormat::float32)
        return result;
    const ClusterLists members = members_of(clustering.clusters, fits.size());
    parallel_for(fits.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t n = members[k].size();
            const MemberCoordinates of = coordinates_of(points, significance, result, k, members[k]);
            for (std::size_t j = 0; j < result.components_of(k); ++j) {
                const WeightGrid own = WeightGrid::of_bits(fits[k].plan.bits[j]);
                result.grids[k * result.max_components + j] = own;
                const double length =
                    best_length(std::span(of.along).subspan(j * n, n), of.significance, own.steps());
                for (std::size_t i = 0; i < result.dimension; ++i)
                    result.row(k, j)[i] =
                        static_cast<float>(length * static_cast<double>(result.row(k, j)[i]));
            }
        }
    });
    return result;
}

std::vector<float> scale_predictors(const Clustering& clustering, QuantisedClusters& clusters) {
    std::vector<float> scales;
    for (std::size_t g = 0; g < clusters.predictors; ++g) {
        double variance = 0;
        for (const ClusterFit& fit : clustering.fits)
            variance += fit.significance * fit.predictor_variances[g];
        scales.push_back(
            static_cast<float>(1 / std::sqrt(std::max(variance, tuning::kMinPredictorVariance))));
        for (std::size_t k = 0; k < clusters.clusters(); ++k) {
            const float center = scales.back() * clusters.center(k)[g], whole = std::round(center);
            clusters.center(k)[g] = whole;
            for (std::size_t i = 0; i < clusters.dimension; ++i) {
                clusters.slope(k, g)[i] /= scales.back();
                clusters.mean(k)[i] += (whole - center) * clusters.slope(k, g)[i];
            }
        }
    }
    return scales;
}

std::vector<double> RowSteps::of(std::size_t k) const {
    std::vector<double> result;
    for (std::size_t g = 0; g < groups(); ++g)
        result.insert(result.end(), static_cast<std::size_t>(axes[g]),
                      std::ldexp(least, exponents[k * groups() + g]));
    return result;
}

void round_rows(AffineClusters& clusters, const RowSteps& steps) {
    for (std::size_t k = 0; k < clusters.clusters(); ++k) {
        const std::vector<double> of = steps.of(k);
        for_rows(clusters, k, [&](float* row, int factor) {
            for (std::size_t i = 0; i < clusters.dimension; ++i)
                row[i] = static_cast<float>(std::round(static_cast<double>(row[i]) / (factor * of[i])) *
                                            factor * of[i]);
        });
    }
}

void copy_cluster(const QuantisedClusters& source, std::size_t from, QuantisedClusters& clusters,
                  std::size_t to) {
    const std::size_t d = source.dimension, most = source.max_components;
    std::copy_n(source.mean(from), d, clusters.mean(to));
    std::copy_n(source.center(from), source.predictors, clusters.center(to));
    std::copy_n(source.slope(from, 0), source.predictors * d, clusters.slope(to, 0));
    std::copy_n(source.row(from, 0), most * d, clusters.row(to, 0));
    std::copy_n(source.grids.begin() + static_cast<std::ptrdiff_t>(from * most), most,
                clusters.grids.begin() + static_cast<std::ptrdiff_t>(to * most));
    clusters.components[to] = source.components[from];
}

QuantisedClusters without_rows(const QuantisedClusters& clusters, std::size_t dimension) {
    QuantisedClusters result{
        AffineClusters(clusters.clusters(), dimension, clusters.max_components, clusters.predictors),
        clusters.grids};
    result.components = clusters.components;
    result.centers = clusters.centers;
    return result;
}

QuantisedClusters truncated(const QuantisedClusters& clusters, std::size_t dimension) {
    QuantisedClusters result = clusters;
    result.dimension = dimension;
    const auto keep = [&](std::vector<float>& rows) {
        std::vector<float> kept;
        for (std::size_t first = 0; first < rows.size(); first += clusters.dimension)
            kept.insert(kept.end(), rows.begin() + static_cast<std::ptrdiff_t>(first),
                        rows.begin() + static_cast<std::ptrdiff_t>(first + dimension));
        rows = std::move(kept);
    };
    if (clusters.dimension > 0) {
        keep(result.means);
        keep(result.slopes);
        keep(result.rows);
    }
    return result;
}

} // namespace prt
