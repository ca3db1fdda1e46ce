// Removes baked light for viewers without PRT (docs/format.md, "Fallback"): vertex colours, and materials that
// are unlit because of it.

import { VERTICES } from "./wholeExtension.js";

const UNLIT = "KHR_materials_unlit";

/** Removes the fallback from `json`, a whole glTF, before three reads materials and attributes. */
export function setFallbackAside(json) {
  if (!json.extensions?.[VERTICES]?.fallback) return;
  const lit = new Set();
  json.materials?.forEach(({ extensions }, i) => {
    if (extensions?.[UNLIT]?.extras?.prtkit !== "fallback") return;
    delete extensions[UNLIT];
    lit.add(i);
  });
  const primitives = json.meshes?.flatMap((mesh) => mesh.primitives ?? []) ?? [];
  for (const { attributes, material } of primitives) {
    if (!attributes || !lit.has(material)) continue;
    delete attributes.COLOR_0;
    if (attributes._PRT_COLOR_0 !== undefined) attributes.COLOR_0 = attributes._PRT_COLOR_0;
    delete attributes._PRT_COLOR_0;
  }
}
