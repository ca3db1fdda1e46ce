#pragma once

#include "support/glb_file.h"

#include <string>
#include <vector>

namespace prt::test {

struct ShippedFile {
    std::string name;
    GlbFile file;
};

/// Creates valid shipped files of every kind: each choice of predictors, fixed and variable bits, weights as
/// floats and as bytes, coded and plain rows, lamps, quantised normals, mirrored nodes, lightmaps.
std::vector<ShippedFile> shipped_files();

/// Creates a triangle with a volume with plain bases, and one with coded bases.
std::vector<ShippedFile> volume_files();

} // namespace prt::test
