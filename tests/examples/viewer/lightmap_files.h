#pragma once

// Files of a ball on a floor: without transfer, baked at vertices, and baked at texels with separate
// coordinates.

#include "pictures/model.h"

#include "support/temporary_folder.h"

#include <filesystem>

namespace viewer {

class LightmapFiles {
public:
    LightmapFiles();

    std::filesystem::path unbaked() const { return folder_ / "ball.glb"; }
    /// Raw transfer of vertices.
    std::filesystem::path vertices() const;
    /// Raw transfer of a map with `size` texels along its sides.
    std::filesystem::path raw(int size = 64) const;
    /// Compressed transfer of a map with `size` texels along its sides.
    std::filesystem::path shipped(int size = 64) const;
    const prt::test::TemporaryFolder& folder() const { return folder_; }

private:
    void write_raw(int size, const std::filesystem::path& path) const;
    void write_shipped(int size, const std::filesystem::path& path) const;

    prt::test::TemporaryFolder folder_;
};

} // namespace viewer
