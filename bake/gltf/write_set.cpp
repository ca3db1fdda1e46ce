// Writes the members that sets of all receivers share.
#include "bake/gltf/write_set.h"

#include "runtime/core/support/bits.h"
#include "runtime/core/transfer/evaluate_range.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace prt {
namespace {

Json record_json(const BakeRecord& record) {
    Json json = {{"method", to_string(record.method)},
                 {"backend", to_string(record.backend)},
                 {"raysPerReceiver", record.rays},
                 {"bounces", record.bounces},
                 {"seed", record.seed}};
    if (!record.receivers.empty())
        json["receivers"] = record.receivers;
    json["samplingError"] = record.sampling_error;
    if (record.endless)
        json["endless"] = true;
    if (record.fitted)
        json["fitted"] = true;
    if (!record.media.empty())
        json["media"] = record.media;
    return json;
}

Json set_json(ReceiverKind kind, Coding coding, const TransferLayout& layout, const BakeRecord& record) {
    return {{"receivers", to_string(kind)},
            {"coding", to_string(coding)},
            {"order", layout.order},
            {"terms", terms_json(layout)},
            {"bake", record_json(record)}};
}

/// Returns {"bufferView": ..., "drops": [...]}.
Json write_row_code(GltfContents& contents, const RowCode& code) {
    return {{"bufferView", contents.add_buffer_view(code.bits)}, {"drops", code.drops}};
}

/// Writes predictors and offsets into `set`; nothing if `bases` has none. Origins of predictors are converted
/// to the file's world.
void write_predictors(GltfContents& contents, const Scene& scene, const ClusteredBases& bases, Json& set) {
    if (bases.predictors.empty())
        return;
    Json predictors = Json::array();
    for (const Predictor& predictor : bases.predictors) {
        Json json = {{"kind", to_string(predictor.kind)}};
        if (predictor.kind == PredictorKind::position) {
            const glm::dvec3 origin = scene.world(predictor.origin);
            json["origin"] = {origin.x, origin.y, origin.z};
        }
        json["scale"] = {predictor.scale.x, predictor.scale.y, predictor.scale.z};
        predictors.push_back(std::move(json));
    }
    set["predictors"] = std::move(predictors);
    set["centers"] = write_row_code(contents, encode_rows(bases.centers, bases.predictor_rows()));
}

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

} // namespace

Json terms_json(const TransferLayout& layout) {
    Json terms = Json::array();
    for (const TransferTerm& term : layout.terms) {
        terms.push_back({{"kind", to_string(term.kind)}, {"channels", term.channels}});
        if (!term.name.empty())
            terms.back()["name"] = term.name;
        if (!term.members.empty())
            terms.back()["members"] = term.members;
    }
    return terms;
}

Json write_float_view(GltfContents& contents, std::span<const float> values) {
    Json view = write_view(contents, values);
    view["componentType"] = kFloat;
    return view;
}

Json write_vectors(GltfContents& contents, std::span<const float> vectors, TransferStorage storage) {
    if (storage != TransferStorage::float16)
        return write_float_view(contents, vectors);
    std::vector<std::uint16_t> halves(vectors.size());
    std::transform(vectors.begin(), vectors.end(), halves.begin(), glm::packHalf1x16);
    Json view = write_view(contents, std::span<const std::uint16_t>(halves));
    view["componentType"] = kHalf;
    return view;
}

Json raw_set(ReceiverKind kind, const BakedTransfer& baked) {
    return set_json(kind, Coding::raw, baked.transfer.layout, baked.record);
}

Json write_clustered_set(GltfContents& contents, const Scene& scene, ReceiverKind kind,
                         const CompressedTransfer& compressed) {
    const ClusteredBases& bases = compressed.transfer.bases;
    Json set = set_json(kind, Coding::clustered, bases.layout, compressed.record);
    set["components"] = bases.components;
    write_predictors(contents, scene, bases, set);
    set["bases"] = write_bases(contents, bases);
    if (compressed.transfer.receivers.format == WeightFormat::packed)
        set["packing"] = write_packing(contents, compressed.transfer);
    else if (kind != ReceiverKind::vertices)
        throw Error("the weights of " + std::string(to_string(kind)) +
                    " must be packed; compress with --bits N");
    return set;
}

void add_set(GltfContents& contents, Json set) {
    contents.use_extension(kTransferExtension);
    Json& extension = member(extensions_of(contents.json), kTransferExtension, Json::value_t::object);
    extension["version"] = kTransferVersion;
    member(extension, "sets", Json::value_t::array).push_back(std::move(set));
}

} // namespace prt
