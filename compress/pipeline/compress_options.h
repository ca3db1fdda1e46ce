#pragma once

// Validation and defaults of compression options.

#include "compress/clusters/clustering.h"
#include "prt/compress/compress.h"

namespace prt {

/// Throws `Error` for input or options that do not allow compression.
void check_input(const TransferView& transfer, const ReceiverSurface& surface,
                 const CompressOptions& options);

/// Returns the given metric, or that of outdoor light, `balanced`.
LightMetric metric_of(const CompressOptions& options, const TransferView& transfer,
                      std::span<const float> areas);

/// Returns the given basis share or its tuned default; 0 for float weights.
double basis_share(const CompressOptions& options);

/// Returns whether the file stores its bases in rounded code.
bool bases_are_coded(const CompressOptions& options);

/// Returns the options of the clustering for transfer of this dimension.
ClusteringOptions clustering_options(const CompressOptions& options, std::size_t dimension);

} // namespace prt
