// Projection of a sky beside the main thread, which a large one holds up for a second.

import { HalfFloatType } from "three";
import { projectEquirectangular, texels } from "./equirectangular.js";
import { MAX_ORDER, ShLight } from "./sphericalHarmonics.js";

/**
 * A promise of what projectEquirectangular returns, made by a worker of its own, which is given a copy of the texels; where
 * there are no workers, as in node, by the caller. Rejects with what projectEquirectangular throws, and with an Error where
 * the worker does not start.
 */
export async function projectInWorker(texture, order = MAX_ORDER, { center = "x" } = {}) {
  if (typeof Worker === "undefined") return projectEquirectangular(texture, order, { center });
  const { value: _value, ...image } = texels(texture);
  const worker = new Worker(new URL("./projectionWorker.js", import.meta.url), { type: "module" });
  try {
    const answer = await new Promise((resolve, reject) => {
      worker.onmessage = ({ data }) => resolve(data);
      worker.onerror = () => reject(new Error("prtkit: projectionWorker.js does not start; is it served beside the plug-in?"));
      worker.postMessage({ image: { ...image, center, half: texture.type === HalfFloatType }, order });
    });
    if (answer.error) throw new RangeError(answer.error);
    return new ShLight(answer.order, answer.polar);
  } finally {
    worker.terminate();
  }
}
