// A closed path through a scene, on its ground.

import { Box3, CatmullRomCurve3, Raycaster, Vector3 } from "three";

const STEP = 0.25; // metres between positions at which the ground height is computed
const DOWN = new Vector3(0, -1, 0);

/** Returns a path around the middle of the scene, for scenes without a path. */
function around(ground) {
  const box = new Box3().setFromObject(ground);
  const [centre, size] = [box.getCenter(new Vector3()), box.getSize(new Vector3())];
  const points = [0, 1, 2, 3, 4, 5].map((i) => [centre.x + 0.3 * size.x * Math.cos((i * Math.PI) / 3), centre.z + 0.3 * size.z * Math.sin((i * Math.PI) / 3)]);
  return { points, from: centre.y };
}

export class Walk {
  /**
   * `way`: `points` [x, z] of a closed path, and the height `from` which rays go down to the ground.
   * `ground`: surfaces to walk on.
   */
  constructor(ground, way = around(ground)) {
    const curve = new CatmullRomCurve3(way.points.map(([x, z]) => new Vector3(x, way.from, z)), true);
    this.length = curve.getLength();
    const ray = new Raycaster();
    this.points = curve.getSpacedPoints(Math.ceil(this.length / STEP)).slice(0, -1);
    let height = null;
    for (const point of this.points) {
      ray.set(point, DOWN);
      const hit = ray.intersectObject(ground)[0];
      height = hit ? hit.point.y : height; // over a hole the height is unchanged
      point.y = height ?? 0;
    }
  }

  /** Returns the position after a distance in metres. */
  at(metres) {
    const count = this.points.length;
    const steps = (((metres / this.length) % 1) + 1) * count;
    const first = Math.floor(steps);
    return this.points[first % count].clone().lerp(this.points[(first + 1) % count], steps - first);
  }

  /** Returns the walking direction there, as a rotation about +Y from +Z. */
  heading(metres) {
    const along = this.at(metres + STEP).sub(this.at(metres - STEP));
    return Math.atan2(along.x, along.z);
  }
}
