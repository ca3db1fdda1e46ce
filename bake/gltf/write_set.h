#pragma once

// Writes sets of receivers: PRTKIT_transfer of docs/format.md.

#include "bake/gltf/contents.h"
#include "prt/core/baked_transfer.h"
#include "prt/gltf/gltf.h"
#include "runtime/load/receiver_sets.h"
#include "runtime/load/transfer_json.h"

#include <cstdint>
#include <span>

namespace prt {

/// Returns [{"kind": "direct", "channels": 1}, ...].
Json terms_json(const TransferLayout& layout);

Json write_float_view(GltfContents& contents, std::span<const float> values);
/// Returns {"bufferView": ...} with a new view for the bytes of `values`.
template <class Value>
Json write_view(GltfContents& contents, std::span<const Value> values) {
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(values))}};
}

/// Writes raw vectors in the format of `storage`.
Json write_vectors(GltfContents& contents, std::span<const float> vectors, TransferStorage storage);

/// Returns a set with raw transfer, without its vectors.
Json raw_set(ReceiverKind kind, const BakedTransfer& baked);
/// Writes the clusters, predictors and bases of `compressed`. Returns a set without clusters and weights of
/// receivers. Origins of predictors are relative to that of `scene`.
Json write_clustered_set(GltfContents& contents, const Scene& scene, ReceiverKind kind,
                         const CompressedTransfer& compressed);
/// Adds `set` to the file, which must have no set of the same receivers.
void add_set(GltfContents& contents, Json set);

/// Returns the result of `work` for the contents; adds the file name to errors.
template <class Document, class Work>
auto named(Document& document, Work&& work) {
    try {
        return work(document.contents());
    } catch (const std::exception& error) { // errors of prtkit, and those of the JSON library for members of
                                            // a wrong type
        throw Error(document.contents().path.string() + ": " + in_plain_words(error));
    }
}

} // namespace prt
