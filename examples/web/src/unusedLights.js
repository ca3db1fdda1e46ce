// Lights of a user's own scene that do not light baked meshes: they are named on the console.

const silent = new WeakSet(); // warned of, or baked

/** Lights that the loader made of a file with transfer: they are lamps of the bake. */
export function noteLightsOfFile(root) {
  root.traverse((object) => object.isLight && silent.add(object));
}

/** The reason why `light` does not light baked meshes as it does others; null: it does. `suns`: as of setSky. */
export function whyUnused(light, suns) {
  if (!light.isDirectionalLight) return "does not light baked meshes: they have the sky, suns, and the lamps that were baked";
  if (!suns) return "does not light baked meshes: name it in setSky(light, scene, { suns: [...] })";
  if (Array.isArray(suns) && !suns.includes(light)) return "lights baked meshes without bounces: name it in suns of setSky, too";
  return null;
}

/** Warns of each such light of `scene` once. */
export function warnOfUnusedLights(scene, suns) {
  scene.traverseVisible((light) => {
    if (!light.isLight || !(light.intensity > 0) || silent.has(light)) return;
    const reason = whyUnused(light, suns);
    if (reason === null) return;
    silent.add(light);
    console.warn(`prtkit: ${light.type} "${light.name || light.uuid}" ${reason}`);
  });
}
