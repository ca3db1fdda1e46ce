#pragma once

// The open model and all results computed for it.

#include "core/findings.h"
#include "core/moving.h"
#include "pictures/settings.h"

#include <optional>

namespace viewer {

/// Size and layout of the transfer.
struct TransferFigures {
    std::size_t raw_bytes = 0;                           ///< uncompressed transfer
    double bytes_per_receiver = 0, bytes_with_bases = 0; ///< compressed transfer
    int clusters = 0, order = 0, channels = 0;
};

/// Size of the transfer of a lightmap, and its maps.
struct LightmapFigures {
    TransferFigures transfer;
    std::vector<prt::LightmapSize> maps;
    std::size_t texels = 0, receivers = 0; ///< number of texels in all maps; number of texels on surfaces, 0:
                                           ///< unknown
};

struct Document {
    LoadedModel loaded;
    LoadedModel beside; ///< the second model, see `OpenModels`
    Occlusion occlusion;
    CompressionSettings compressed_as;  ///< settings of the compressed transfer, existing or in progress
    std::uint64_t transfer_version = 1; ///< increases with every new transfer
    RepeatedBake repeated;
    std::optional<SurfaceBudget> budget; ///< the last measured budget; its light may be outdated
    Moving moving;

    const Model* model() const { return loaded.model.get(); } ///< null: no model is open
    std::string name() const { return model() ? model()->path.filename().string() : std::string(); }
    const prt::Transfer* raw() const { return loaded.raw.get(); }
    const prt::ClusteredTransfer* compressed() const { return loaded.compressed.get(); }
    int raw_order() const { return raw() ? raw()->layout.order : 0; }
    /// Returns the model whose receivers `picture` shows.
    const LoadedModel& shown_by(const SidePicture& picture) const;
    /// True if both vertices and a lightmap are open.
    bool has_both() const { return beside.model != nullptr; }
    /// Returns the model with the lightmap; null if there is none.
    const LoadedModel* lightmap() const {
        return loaded.of_texels() ? &loaded : has_both() ? &beside : nullptr;
    }
    /// Returns the layouts of all transfer in the document.
    std::vector<const prt::TransferLayout*> layouts() const;
    /// Returns the number of bands the light needs: the maximum order of all transfers, at least three.
    int light_order() const;

    void open(const OpenModels& models);
    void set(const Baked& baked);
    void set(const Compressed& found);
};

TransferFigures figures_of(const LoadedModel& loaded);
LightmapFigures lightmap_figures_of(const LoadedModel& loaded);

} // namespace viewer
