// Directional lights of a user's own scene as suns.

import { Vector3 } from "three";

/** Whether three draws by `light`: it and all that it is in are visible, up to `scene`. */
function isIn(scene, light) {
  for (let at = light; at?.visible; at = at.parent) if (at === scene) return true;
  return false;
}

/** Throws an Error unless all of `lights` are DirectionalLights. */
export function checkSunLights(lights) {
  for (const light of lights)
    if (!light?.isDirectionalLight)
      throw new Error(`prtkit: suns is an array of DirectionalLights, or what lightOfSuns returns; it holds ${light?.type ?? typeof light}`);
}

/** The suns of `lights`, as lightOfSuns takes them, in directions of the world; without those that three does not draw by. */
export function sunsOf(lights, scene) {
  return lights
    .filter((light) => isIn(scene, light))
    .map((light) => {
      light.updateWorldMatrix(true, false);
      light.target.updateWorldMatrix(true, false);
      const towards = new Vector3().setFromMatrixPosition(light.matrixWorld);
      towards.sub(new Vector3().setFromMatrixPosition(light.target.matrixWorld)).normalize();
      return { towards: towards.toArray(), irradiance: light.color.toArray().map((value) => value * light.intensity), halfAngle: 0 };
    });
}
