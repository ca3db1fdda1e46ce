// Stores findings in the document and computes its figures.

#include "core/document.h"

#include "core/transfer_work.h"

#include <algorithm>

namespace viewer {

const LoadedModel& Document::shown_by(const SidePicture& picture) const {
    return has_both() && picture.receivers == Receivers::texels && shows_transfer(picture.kind) ? beside
                                                                                                : loaded;
}

int Document::light_order() const {
    int order = 3;
    for (const prt::TransferLayout* layout : layouts())
        order = std::max(order, layout->order);
    return order;
}

std::vector<const prt::TransferLayout*> Document::layouts() const {
    std::vector<const prt::TransferLayout*> layouts;
    for (const LoadedModel* model : {&loaded, &beside}) {
        if (model->raw)
            layouts.push_back(&model->raw->layout);
        if (model->compressed)
            layouts.push_back(&model->compressed->bases.layout);
        if (model->instanced)
            layouts.push_back(&model->instanced->compressed->transfer.bases.layout);
    }
    if (const auto& volume = moving.volume().volume)
        layouts.push_back(&volume->compressed.transfer.bases.layout);
    return layouts;
}

void Document::open(const OpenModels& models) {
    loaded = models.first;
    beside = models.beside;
    occlusion = nullptr;
    repeated = {};
    budget.reset();
    moving.enter(models.first.model);
    if (!loaded.has_transfer())
        loaded.record.bounces = kBakeBounces;
    if (compressed()) {
        const prt::ClusteredBases& bases = compressed()->bases;
        compressed_as = {bases.layout.order, static_cast<int>(bases.clusters()), bases.max_components()};
    } else {
        compressed_as = {.order = raw() ? raw()->layout.order : kBakeOrder};
    }
    ++transfer_version;
}

void Document::set(const Baked& baked) {
    loaded.raw = baked.transfer;
    loaded.record = baked.record;
    repeated = {};
    ++transfer_version;
}

void Document::set(const Compressed& found) {
    LoadedModel& model = found.model == beside.model ? beside : loaded;
    if (found.lightmap)
        model.set(found.lightmap);
    else
        model.compressed = found.transfer;
    if (&model == &loaded)
        compressed_as = found.how;
    ++transfer_version;
}

TransferFigures figures_of(const LoadedModel& loaded) {
    TransferFigures figures;
    if (loaded.raw) {
        figures.raw_bytes = loaded.raw->vectors.size() * sizeof(float);
        figures.order = loaded.raw->layout.order;
        figures.channels = loaded.raw->layout.channels();
    }
    if (loaded.compressed) {
        const prt::ClusteredBases& bases = loaded.compressed->bases;
        const auto receivers =
            static_cast<double>(std::max<std::size_t>(1, loaded.compressed->receivers.size()));
        figures.bytes_per_receiver = static_cast<double>(prt::bytes_per_receiver(*loaded.compressed));
        figures.bytes_with_bases =
            figures.bytes_per_receiver + static_cast<double>(prt::basis_bytes(bases)) / receivers;
        figures.clusters = static_cast<int>(bases.clusters());
        figures.order = bases.layout.order;
        figures.channels = bases.layout.channels();
    }
    return figures;
}

LightmapFigures lightmap_figures_of(const LoadedModel& loaded) {
    const prt::LightmapLayout& layout = *loaded.lightmap.layout();
    return {.transfer = figures_of(loaded),
            .maps = layout.maps,
            .texels = layout.texels(),
            .receivers = loaded.lightmap.baked ? loaded.lightmap.baked->texels.size() : 0};
}

} // namespace viewer
