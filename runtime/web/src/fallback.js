// Removes baked light for viewers without PRT (docs/format.md, "Fallback"): vertex colours, and materials that
// are unlit because of it.

const UNLIT = "KHR_materials_unlit";

/** Returns the primitives of all meshes of a glTF. */
export const primitivesOf = ({ meshes }) => meshes?.flatMap((mesh) => mesh?.primitives ?? []) ?? [];

/** Removes the fallback from `json`, a whole glTF whose set of vertices has one, before three reads materials and attributes. */
export function setFallbackAside(json) {
  const lit = new Set();
  json.materials?.forEach(({ extensions }, i) => {
    if (extensions?.[UNLIT]?.extras?.prtkit !== "fallback") return;
    delete extensions[UNLIT];
    lit.add(i);
  });
  for (const { attributes, material } of primitivesOf(json)) {
    if (!attributes || !lit.has(material)) continue;
    delete attributes.COLOR_0;
    if (attributes._PRT_COLOR_0 !== undefined) attributes.COLOR_0 = attributes._PRT_COLOR_0;
    delete attributes._PRT_COLOR_0;
  }
}
