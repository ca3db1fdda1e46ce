#pragma once

#include "points.h"

namespace prt {

/// Fits every cluster's mean and up to `components` principal directions to its points, weighted, in double.
/// Directions without variance beyond rounding are left out. Clusters without points keep their mean and have
/// no directions.
void fit_local_pca(const PointBlocks& points, std::span<const float> weights,
                   std::span<const std::uint32_t> clusters, int components, ClusterModels& models,
                   int threads);

/// Exact squared distance of `point` to the subspace of cluster `k`, in double, and its weights [components].
double project_point(const PointBlocks& points, std::size_t point, const ClusterModels& models, std::size_t k,
                     std::span<double> weights);

} // namespace prt
