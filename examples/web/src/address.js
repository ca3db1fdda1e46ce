// Stores the state of the page in its address: a link shows the same state.

/** Returns the numbers of a parameter of the address, or undefined. */
export function vectorOf(asked, name) {
  return asked.get(name)?.split(",").map(Number);
}

const rounded = (values) => values.map((value) => Number(value.toFixed(3))).join(",");

/**
 * Returns the address of the current state. `names`: those of model and sky; a user's file has no name and is
 * not part of a link.
 */
export function addressOf(picture, { model, quality, sky, comparing, panel }) {
  const { camera, controls } = picture;
  const degrees = (picture.angle * 180) / Math.PI;
  const settings = {
    ...(model === undefined ? {} : { model, quality }),
    ...(sky === undefined ? {} : { sky }),
    suns: Number(picture.separateSuns),
    window: picture.window,
    angle: Number((degrees - 360 * Math.round(degrees / 360)).toFixed(2)),
    exposure: picture.stops,
    shine: Number(picture.shine),
    ...Object.fromEntries(Object.entries(picture.moving.shown).map(([part, shown]) => [part, Number(shown)])),
    ...(comparing ? { split: Number(picture.split.toFixed(2)) } : {}),
    camera: rounded(camera.position.toArray()),
    target: rounded(controls.target.toArray()),
    fov: picture.fieldOfView,
    ...(panel === null ? {} : { panel }),
  };
  return `${location.pathname}?${Object.entries(settings).map(([name, value]) => `${name}=${encodeURIComponent(value).replaceAll("%2C", ",")}`).join("&")}`;
}
