// Suns by the keys of a light set: hard shadows of a day without a shadow map.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (v) => v.map((x) => x / Math.hypot(...v));

/** About +Y by `angle` radians, as lights are turned. */
function turned([x, y, z], angle) {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  return [c * x + s * z, y, c * z - s * x];
}

/** The place nearest to `sun` within the arc from key `a` to key `b`; null where that is one of the keys, and
 * where these are one, or more than a right angle apart: what only one of them lights would be far too bright. */
function withinArc(a, b, sun) {
  const between = dot(a, b);
  const ofA = dot(a, sun) - between * dot(b, sun);
  const ofB = dot(b, sun) - between * dot(a, sun);
  if (between < 0 || 1 - between < 1e-9 || ofA <= 0 || ofB <= 0) return null;
  const length = Math.hypot(...a.map((x, i) => ofA * x + ofB * b[i]));
  return { shares: [ofA / length, ofB / length], cosine: (ofA * dot(a, sun) + ofB * dot(b, sun)) / length };
}

/** [key, share] of the one key or the two neighbours among `keys` by which `sun` shines. All unit directions. */
function placeOf(keys, sun) {
  let best = { cosine: -Infinity, shares: [] };
  keys.forEach((key, k) => {
    const cosine = dot(key, sun);
    if (cosine > best.cosine) best = { cosine, shares: [[k, 1]] };
    const place = k + 1 < keys.length ? withinArc(key, keys[k + 1], sun) : null;
    if (place && place.cosine > best.cosine)
      best = { cosine: place.cosine, shares: place.shares.map((share, i) => [k + i, share]) };
  });
  return best.shares;
}

/**
 * Strengths by name of the keys of a model that shine for `suns`, whose light is turned about +Y by `angle` radians. `keys`:
 * [{ name, towards }] in their order. What both keys next to a sun light has the irradiance of the sun itself.
 */
export function strengthsOfSuns(keys, suns, angle = 0) {
  const strengths = Object.fromEntries(keys.map(({ name }) => [name, [0, 0, 0]]));
  const directions = keys.map(({ towards }) => unit(towards));
  for (const { towards, irradiance } of suns)
    for (const [k, share] of placeOf(directions, unit(turned(towards, angle))))
      irradiance.forEach((value, c) => (strengths[keys[k].name][c] += share * value));
  return strengths;
}
