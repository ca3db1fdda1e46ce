#pragma once

// Writes the common JSON of the transfer extensions of prtkit.

#include "bake/gltf/contents.h"
#include "prt/gltf/gltf.h"
#include "runtime/load/transfer_json.h"

#include <span>

namespace prt {

Json record_json(const BakeRecord& record);

Json write_float_view(GltfContents& contents, std::span<const float> values);
Json write_half_view(GltfContents& contents, std::span<const float> values);

/// Returns {"bufferView": ..., "drops": [...]}.
Json write_row_code(GltfContents& contents, const RowCode& code);

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
