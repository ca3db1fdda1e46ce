#pragma once

// Zonal lobes of vertices in glTF files.

#include "prt/load/model.h"
#include "runtime/load/gltf_data.h"

#include <cstddef>
#include <optional>
#include <string>

namespace prt {

inline constexpr int kLobeVersion = 1;

/// Returns the name of the attribute that holds a lobe.
std::string lobe_name(std::size_t lobe);

/// Returns whether the vertices of a primitive have lobes.
bool has_lobes(const GltfData& data, const GltfPrimitive& primitive);

/// Returns the lobes of the vertices of `scene`: words of 0, which give no light, for arrays without lobes.
/// Empty if no array has lobes. Throws `Error` if they are damaged, too large or of another version.
std::optional<StoredLobes> read_lobes(const GltfData& data, const Scene& scene);

} // namespace prt
