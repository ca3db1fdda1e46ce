// Models whose vertices have the transfer: PRTKIT_clustered_pca.

import { bakedFrame } from "./bakedFrame.js";
import { decodeClusters } from "./clusteredPca.js";
import { PrtkitModel } from "./PrtkitModel.js";
import { TABLES } from "./tables.js";
import { convertGeometry } from "./vertexWeights.js";
import { checkExtension, viewsOf } from "./wholeExtension.js";

/** What a file with `extension` has: { model, of, definesOf }. `of(mesh)`: what the mesh is lit by, null where it is not;
 * `definesOf(geometry)`: of its attributes, which are then those that the shader reads, null where it has none. */
export async function transferOfVertices(extension, views, root) {
  checkExtension(extension);
  const bytes = await views(viewsOf(extension));
  const model = new PrtkitModel(decodeClusters(extension, (i) => bytes.get(i)), root);
  const defines = new Map(); // by geometry: nodes may share one
  const definesOf = (geometry) => {
    if (!defines.has(geometry)) {
      if (!Object.keys(geometry.attributes).some((name) => name.startsWith("_prt_"))) return null;
      const converted = convertGeometry(geometry, model.clusters);
      defines.set(geometry, { ...TABLES, ...converted.defines });
      model.bytesPerVertex = converted.bytesPerVertex;
      model.vertices += geometry.getAttribute("position").count;
    }
    return defines.get(geometry);
  };
  const of = (mesh) => {
    const own = model.instances?.transferOf(mesh) ?? null;
    if (own) return own;
    const { geometry } = mesh;
    if (!definesOf(geometry)) return null;
    const frame = bakedFrame(mesh, model.clusters.guides);
    return { uniforms: frame.uniforms, defines: { ...definesOf(geometry), ...frame.defines } };
  };
  return { model, of, definesOf };
}
