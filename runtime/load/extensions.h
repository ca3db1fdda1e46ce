#pragma once

// Names and versions of glTF extensions.

namespace prt {

inline constexpr const char* kTransferExtension = "PRTKIT_transfer"; ///< at primitives, and at the top level
inline constexpr const char* kLobeExtension = "PRTKIT_lobes";
inline constexpr const char* kInstancesExtension = "PRTKIT_instances"; ///< at nodes, and at the top level
inline constexpr const char* kOccluderExtension = "PRTKIT_occlusion_volume"; ///< at nodes

/// Extensions for transfer in former versions, which only removal of transfer supports.
inline constexpr const char* kFormerClusteredExtension = "PRTKIT_clustered_pca";
inline constexpr const char* kFormerExtensions[] = {kFormerClusteredExtension, "PRTKIT_lightmap",
                                                    "PRTKIT_transfer_volume"};

inline constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";
inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";
inline constexpr const char* kInstancingExtension = "EXT_mesh_gpu_instancing";

} // namespace prt
