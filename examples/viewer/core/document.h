#pragma once

// The model that is open, and all that was found out about it.

#include "core/findings.h"
#include "core/moving.h"
#include "pictures/settings.h"

#include <optional>

namespace viewer {

/// What transfer takes.
struct TransferFigures {
    std::size_t raw_bytes = 0;                           ///< as baked
    double bytes_per_receiver = 0, bytes_with_bases = 0; ///< compressed
    int clusters = 0, order = 0, channels = 0;
};

/// What that of texels takes, and where they are.
struct LightmapFigures {
    TransferFigures transfer;
    std::vector<prt::LightmapSize> maps;
    std::size_t texels = 0, receivers = 0; ///< of the maps; those on surfaces, 0: the file does not say
};

struct Document {
    LoadedModel loaded;
    LoadedModel beside; ///< `OpenModels`
    Occlusion occlusion;
    CompressionSettings compressed_as;  ///< the compressed transfer, or the one that is on its way
    std::uint64_t transfer_version = 1; ///< counts up with every transfer
    RepeatedBake repeated;
    std::optional<SurfaceBudget> budget; ///< the last that was measured, which may be of another light
    Moving moving;

    const Model* model() const { return loaded.model.get(); } ///< null: nothing is open
    std::string name() const { return model() ? model()->path.filename().string() : std::string(); }
    const prt::Transfer* raw() const { return loaded.raw.get(); }
    const prt::ClusteredTransfer* compressed() const { return loaded.compressed.get(); }
    int raw_order() const { return raw() ? raw()->layout.order : 0; }
    /// Those of the receivers that a picture shows.
    const LoadedModel& shown_by(const SidePicture& picture) const;
    /// Both vertices and a lightmap are open.
    bool has_both() const { return beside.model != nullptr; }
    /// Null: there is none.
    const LoadedModel* lightmap() const {
        return loaded.of_texels() ? &loaded : has_both() ? &beside : nullptr;
    }
    /// Of all transfer that there is.
    std::vector<const prt::TransferLayout*> layouts() const;
    /// Bands that the light needs: as many as the transfers have, three at least.
    int light_order() const;

    void open(const OpenModels& models);
    void set(const Baked& baked);
    void set(const Compressed& found);
};

TransferFigures figures_of(const LoadedModel& loaded);
LightmapFigures lightmap_figures_of(const LoadedModel& loaded);

} // namespace viewer
