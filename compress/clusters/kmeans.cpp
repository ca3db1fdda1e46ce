#include "clusters/kmeans.h"

#include <algorithm>

namespace prt {
namespace {

double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// An index with probability proportional to weights[i] · errors[i]; the count when all are zero.
std::size_t draw(std::span<const float> weights, std::span<const float> errors, std::mt19937_64& random) {
    double total = 0;
    for (std::size_t i = 0; i < weights.size(); ++i)
        total += static_cast<double>(weights[i]) * static_cast<double>(errors[i]);
    if (!(total > 0))
        return weights.size();
    double target = uniform(random) * total;
    std::size_t last = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double share = static_cast<double>(weights[i]) * static_cast<double>(errors[i]);
        if (share <= 0)
            continue;
        last = i;
        target -= share;
        if (target < 0)
            break;
    }
    return last;
}

ClusterModels seed_centers(const PointBlocks& points, std::span<const float> weights, std::size_t clusters,
                           std::size_t max_components, std::mt19937_64& random, int threads,
                           const Progress& progress) {
    ClusterModels models(clusters, points.dimension, max_components);
    std::vector<float> errors(points.count, 1.0f); // the first centre: by weight alone
    std::size_t found = 0;
    for (; found < clusters; ++found) {
        progress.update(0);
        const std::size_t point = draw(weights, errors, random);
        if (point == points.count)
            break;
        points.copy_point(point, models.mean(found));
        if (found == 0)
            std::fill(errors.begin(), errors.end(), std::numeric_limits<float>::infinity());
        lower_to_distance(points, models.mean(found), errors, threads);
    }
    models.components.resize(found);
    models.penalties.resize(found);
    models.means.resize(found * points.dimension);
    models.directions.resize(found * max_components * points.dimension);
    return models;
}

void move_to_means(const PointBlocks& points, std::span<const float> weights,
                   std::span<const std::uint32_t> clusters, ClusterModels& models) {
    std::vector<double> sums(models.means.size(), 0), totals(models.clusters(), 0);
    for (std::size_t p = 0; p < points.count; ++p) {
        const double weight = static_cast<double>(weights[p]);
        totals[clusters[p]] += weight;
        for (std::size_t i = 0; i < points.dimension; ++i)
            sums[clusters[p] * points.dimension + i] += weight * static_cast<double>(points.coordinate(p, i));
    }
    for (std::size_t k = 0; k < models.clusters(); ++k)
        if (totals[k] > 0)
            for (std::size_t i = 0; i < points.dimension; ++i)
                models.mean(k)[i] = static_cast<float>(sums[k * points.dimension + i] / totals[k]);
}

} // namespace

ClusterModels vector_quantise(const PointBlocks& points, std::span<const float> weights, std::size_t clusters,
                              std::size_t max_components, std::mt19937_64& random, int threads,
                              const Progress& progress) {
    ClusterModels models = seed_centers(points, weights, clusters, max_components, random, threads, progress);
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < 50; ++iteration) {
        progress.update(0);
        const Assignment assignment = assign(points, models, threads);
        const double error = total_error(weights, assignment.errors);
        if (error == 0 || error > before * (1 - 1e-3))
            break;
        before = error;
        move_to_means(points, weights, assignment.clusters, models);
    }
    return models;
}

} // namespace prt
