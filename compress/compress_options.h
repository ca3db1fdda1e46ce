#pragma once

#include "clusters/clustering.h"
#include "prt/compress.h"

namespace prt {

/// Throws `Error` for what cannot be compressed, or not so.
void check_input(const TransferView& transfer, const ReceiverSurface& surface,
                 const CompressOptions& options);

/// As given, or of outdoor light, `balanced`.
LightMetric metric_of(const CompressOptions& options, const TransferView& transfer,
                      std::span<const float> areas);

/// As given, or as tuned; none beside floats.
double basis_share(const CompressOptions& options);

/// Whether the file holds its bases in code, rounded.
bool bases_are_coded(const CompressOptions& options);

/// What the clustering is told of transfer of this dimension.
ClusteringOptions clustering_options(const CompressOptions& options, std::size_t dimension);

} // namespace prt
