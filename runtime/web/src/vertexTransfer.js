// Loads models with transfer of vertices.

import { bakedFrame } from "./bakedFrame.js";
import { clustersOf } from "./clusteredPca.js";
import { PrtkitModel } from "./PrtkitModel.js";
import { TABLES } from "./tables.js";
import { convertGeometry } from "./vertexWeights.js";
import { viewsOf } from "./wholeExtension.js";

/**
 * Loads a file with this set of vertices: { model, of, definesOf }. `of(mesh)`: the transfer of the mesh, null without
 * one; `definesOf(geometry)`: defines of its attributes, after conversion to those of the shader, null
 * without transfer.
 */
export async function transferOfVertices(set, views, root) {
  const bytes = await views(viewsOf(set));
  const model = new PrtkitModel(clustersOf(set, (i) => bytes.get(i)), root);
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
    const frame = bakedFrame(mesh, model.clusters.predictors);
    return { uniforms: frame.uniforms, defines: { ...definesOf(geometry), ...frame.defines } };
  };
  return { model, of, definesOf };
}
