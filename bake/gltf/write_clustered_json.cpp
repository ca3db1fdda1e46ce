// Writes clusters, bases and packed weights: docs/format.md.
#include "bake/gltf/write_clustered_json.h"

#include "runtime/support/bits.h"
#include "runtime/transfer/evaluate_range.h"

namespace prt {

Json write_bases(GltfContents& contents, const ClusteredBases& bases) {
    check_rows(bases);
    if (!bases.is_coded())
        return write_float_view(contents, bases.rows);
    const CodedBases& coded = bases.coded;
    Json json = {{"origin", write_float_view(contents, coded.origin)},
                 {"scales", write_float_view(contents, coded.scales)},
                 {"axes", write_row_code(contents, coded.axes)},
                 {"values", write_row_code(contents, coded.values)}};
    if (coded.exponents.empty()) {
        json["step"] = coded.step;
    } else {
        json["steps"] = write_row_code(contents, coded.exponents.code);
        json["steps"]["least"] = coded.step;
        json["steps"]["axes"] = coded.exponents.axes;
    }
    if (!coded.units.empty())
        json["units"] = write_float_view(contents, coded.units);
    return json;
}

Json write_packing(GltfContents& contents, const ClusteredTransfer& transfer) {
    BitWriter writer;
    for (const std::uint8_t bits : transfer.bases.bits)
        writer.write(bits - 1u, 4);
    return {{"clusterBits", transfer.receivers.cluster_bits},
            {"bufferView", contents.add_buffer_view(writer.take())}};
}

} // namespace prt
