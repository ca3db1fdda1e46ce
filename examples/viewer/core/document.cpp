#include "core/document.h"

#include "core/transfer_work.h"

#include <algorithm>

namespace viewer {

int Document::light_order() const {
    return std::max({3, raw_order(), compressed() ? compressed()->bases.layout.order : 0});
}

std::vector<const prt::TransferLayout*> Document::layouts() const {
    std::vector<const prt::TransferLayout*> layouts;
    if (raw())
        layouts.push_back(&raw()->layout);
    if (compressed())
        layouts.push_back(&compressed()->bases.layout);
    return layouts;
}

void Document::open(const LoadedModel& model) {
    loaded = model;
    occlusion = nullptr;
    repeated = {};
    budget.reset();
    if (!loaded.raw && !loaded.compressed)
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

void Document::set(const Compressed& compressed) {
    loaded.compressed = compressed.transfer;
    compressed_as = compressed.how;
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
        const auto receivers = static_cast<double>(std::max<std::size_t>(1, loaded.model->scene.receivers()));
        figures.bytes_per_vertex = static_cast<double>(prt::bytes_per_receiver(*loaded.compressed));
        figures.bytes_with_bases =
            figures.bytes_per_vertex + static_cast<double>(prt::basis_bytes(bases)) / receivers;
        figures.clusters = static_cast<int>(bases.clusters());
        figures.order = bases.layout.order;
        figures.channels = bases.layout.channels();
    }
    return figures;
}

} // namespace viewer
