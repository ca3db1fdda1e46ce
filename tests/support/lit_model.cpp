// Builds a small file with transfer.

#include "support/lit_model.h"

#include "prt/gltf/gltf.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <random>
#include <span>

namespace prt::test {

std::vector<std::byte> lit_model() {
    const TemporaryFolder folder;
    triangle_file().write(folder / "scene.glb");
    GltfDocument document = load_gltf(folder / "scene.glb");
    const Scene scene = extract_scene(document);
    CompressedTransfer compressed;
    ClusteredTransfer& transfer = compressed.transfer;
    transfer.bases.layout = layout_of_one(3, 1);
    transfer.bases.components = {4, 2};
    std::mt19937 random(5);
    for (std::size_t i = 0; i < 8 * transfer.bases.dimension(); ++i)
        transfer.bases.rows.push_back(static_cast<float>(random() % 1000) / 1000);
    transfer.receivers.components = 4;
    transfer.receivers.clusters = {0, 1, 0};
    const float weights[] = {1, 0.03f, 0.05f, 0.07f, 0.09f, 0.01f, 0, 0, 0.01f, 0.02f, 0.03f, 0.04f};
    const auto bytes = std::as_bytes(std::span(weights));
    transfer.receivers.weights.assign(bytes.begin(), bytes.end());
    write_clustered(document, scene, compressed);
    save_glb(document, folder / "lit.glb");
    return read_file(folder / "lit.glb");
}

} // namespace prt::test
