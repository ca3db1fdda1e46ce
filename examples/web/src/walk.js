// A way round a scene, on its ground.

import { Box3, CatmullRomCurve3, Raycaster, Vector3 } from "three";

const STEP = 0.25; // metres between places where the ground is looked for
const DOWN = new Vector3(0, -1, 0);

/** Round the middle of what there is, for scenes that say nothing of a way. */
function around(ground) {
  const box = new Box3().setFromObject(ground);
  const [centre, size] = [box.getCenter(new Vector3()), box.getSize(new Vector3())];
  const points = [0, 1, 2, 3, 4, 5].map((i) => [centre.x + 0.3 * size.x * Math.cos((i * Math.PI) / 3), centre.z + 0.3 * size.z * Math.sin((i * Math.PI) / 3)]);
  return { points, from: centre.y };
}

export class Walk {
  /** `way`: `points` [x, z] that it goes through and comes back from the last to the first, and the height `from` which the
   * ground is looked for downwards. `ground`: what may be walked on. */
  constructor(ground, way = around(ground)) {
    const curve = new CatmullRomCurve3(way.points.map(([x, z]) => new Vector3(x, way.from, z)), true);
    this.length = curve.getLength();
    const ray = new Raycaster();
    this.places = curve.getSpacedPoints(Math.ceil(this.length / STEP)).slice(0, -1);
    let height = null;
    for (const place of this.places) {
      ray.set(place, DOWN);
      const hit = ray.intersectObject(ground)[0];
      height = hit ? hit.point.y : height; // over a hole it goes on as before
      place.y = height ?? 0;
    }
  }

  /** The place after so many metres. */
  at(metres) {
    const count = this.places.length;
    const steps = (((metres / this.length) % 1) + 1) * count;
    const first = Math.floor(steps);
    return this.places[first % count].clone().lerp(this.places[(first + 1) % count], steps - first);
  }

  /** Where it goes there, as a turn about +Y from +Z. */
  heading(metres) {
    const along = this.at(metres + STEP).sub(this.at(metres - STEP));
    return Math.atan2(along.x, along.z);
  }
}
