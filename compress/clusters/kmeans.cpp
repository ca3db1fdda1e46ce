// Vector quantisation, the start of clustered PCA: k-means++ seeding (Arthur and Vassilvitskii 2007), then
// Lloyd's iteration (Lloyd 1982) until the error hardly decreases.

#include "compress/clusters/kmeans.h"

#include "compress/tuning/tuning.h"

namespace prt {
namespace {

double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Returns an index with probability proportional to significance[i] · errors[i]; the count if all are zero.
std::size_t draw(std::span<const float> significance, std::span<const float> errors,
                 std::mt19937_64& random) {
    const double total = total_error(significance, errors);
    if (!(total > 0))
        return errors.size();
    double target = uniform(random) * total;
    std::size_t last = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const double share = static_cast<double>(significance[i]) * static_cast<double>(errors[i]);
        if (share <= 0)
            continue;
        last = i;
        target -= share;
        if (target < 0)
            break;
    }
    return last;
}

/// Returns centers by k-means++; each is drawn by its error relative to the previous ones.
PenalisedClusters seed_centers(const PointBlocks& points, std::span<const float> significance,
                               std::size_t most, std::mt19937_64& random, int threads,
                               const Progress& progress) {
    std::vector<float> errors(points.count, 1.0f); // the first center is drawn by significance alone
    std::vector<std::size_t> centers;
    std::vector<float> center(points.width());
    while (centers.size() < most) {
        progress.update(static_cast<double>(centers.size()) / static_cast<double>(most));
        const std::size_t point = draw(significance, errors, random);
        if (point == points.count)
            break;
        if (centers.empty())
            std::fill(errors.begin(), errors.end(), std::numeric_limits<float>::infinity());
        centers.push_back(point);
        points.copy_point(point, center.data());
        lower_to_distance(points, center.data(), errors, threads);
    }
    PenalisedClusters clusters(centers.size(), points.dimension, 0);
    for (std::size_t k = 0; k < centers.size(); ++k)
        for (std::size_t i = 0; i < points.dimension; ++i)
            clusters.mean(k)[i] = points.coordinate(centers[k], i);
    return clusters;
}

void move_to_means(const PointBlocks& points, std::span<const float> significance,
                   std::span<const std::uint32_t> assigned, AffineClusters& clusters) {
    std::vector<double> sums(clusters.means.size(), 0), totals(clusters.clusters(), 0);
    for (std::size_t p = 0; p < points.count; ++p) {
        const double share = static_cast<double>(significance[p]);
        totals[assigned[p]] += share;
        for (std::size_t i = 0; i < points.dimension; ++i)
            sums[assigned[p] * points.dimension + i] += share * static_cast<double>(points.coordinate(p, i));
    }
    for (std::size_t k = 0; k < clusters.clusters(); ++k)
        if (totals[k] > 0)
            for (std::size_t i = 0; i < points.dimension; ++i)
                clusters.mean(k)[i] = static_cast<float>(sums[k * points.dimension + i] / totals[k]);
}

} // namespace

PenalisedClusters vector_quantise(const PointBlocks& points, std::span<const float> significance,
                                  std::size_t clusters, std::mt19937_64& random, int threads,
                                  const Progress& progress) {
    PenalisedClusters found =
        seed_centers(points, significance, clusters, random, threads, progress.range(0, 0.5));
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < tuning::kMaxLloydIterations; ++iteration) {
        progress.update(0.5 + 0.5 * iteration / tuning::kMaxLloydIterations);
        const Assignment assignment = assign(points, found, threads);
        const double error = total_error(significance, assignment.errors);
        if (error == 0 || error > before * (1 - tuning::kLloydTolerance))
            break;
        before = error;
        move_to_means(points, significance, assignment.clusters, found);
    }
    return found;
}

} // namespace prt
