// shaders/prt_volume.glsl and volumeLight.glsl in three's node language, for WebGPURenderer, with the same names. Nodes are created
// while a lighting model is evaluated, within its flow.

import {
  cameraViewMatrix,
  float,
  If,
  int,
  ivec2,
  ivec3,
  mat3,
  mix,
  normalWorldGeometry,
  positionWorld,
  positionViewDirection,
  textureLoad,
  uint,
  uniform,
  uniformArray,
  uvec2,
  vec3,
  vec4,
} from "three/tsl";
import { DataTexture, Texture3DNode } from "three/webgpu";
import { SIDE } from "./volumeGrid.js";

const WIDTH = 2048; // width of tables

/** Returns the integers of a 3D texture as a table: three has no integer 3D textures on WebGPU. */
function tableOf({ image: { data, width, height, depth }, format, type }) {
  const rows = Math.ceil((width * height * depth) / WIDTH);
  const padded = new Uint32Array((data.length / (width * height * depth)) * WIDTH * rows);
  padded.set(data);
  const texture = new DataTexture(padded, WIDTH, rows, format, type);
  texture.needsUpdate = true;
  const entry = (at) => {
    const i = at.z.mul(height).add(at.y).mul(width).add(at.x).toVar();
    return textureLoad(texture, ivec2(i.mod(WIDTH), i.div(WIDTH)));
  };
  return { texture, entry };
}

/** A texel of a 3D texture at integer coordinates; three has no node for it. */
class TexelNode extends Texture3DNode {
  static get type() {
    return "PrtTexelNode";
  }

  generateUV(builder, uvNode) {
    return uvNode.build(builder, "ivec3");
  }

  generateSnippet(builder, texture, at) {
    return builder.renderer.backend.isWebGPUBackend ? `textureLoad( ${texture}, ${at}, 0u )` : `texelFetch( ${texture}, ${at}, 0 )`;
  }
}
const texel = (texture, at) => new TexelNode(texture, at).setSampler(false);

/** Returns the textures and parameters of a volume. */
function tablesOf(volume) {
  const { uniforms, source, atlas } = volume;
  volume.tables ??= [uniforms.prt_volume_visibility.value, uniforms.prt_volume_index.value].map(tableOf);
  const [visibility, index] = volume.tables.map(({ entry }) => entry);
  return {
    light: uniforms.prt_volume_light.value,
    visibility,
    index,
    spacing: source.grid.spacing,
    size: source.grid.size,
    first: uniforms.prtVolumeFirst.value,
    bricks: atlas.bricks,
    coefficients: source.clusters.outputs,
  };
}

const CORNERS = Array.from({ length: 8 }, (_, i) => [i & 1, (i >> 1) & 1, i >> 2]);
const AXES = ["x", "y", "z"];

/** Changes `brick` to the one that contains a position inside the volume, if there is one. */
function findBrick({ index, spacing, size }, position, brick) {
  const bricks = position.div(4 * spacing);
  const cell = ivec3(bricks.floor()).clamp(ivec3(0), ivec3(...size).sub(1)).toVar();
  const entry = index(cell).x.toVar();
  If(entry.notEqual(uint(0xffffffff)), () => {
    brick.level.assign(int(entry.bitAnd(uint(3))));
    brick.slot.assign(int(entry.shiftRight(uint(2))));
    for (const axis of AXES) brick.first[axis].assign(cell[axis].shiftRight(brick.level).shiftLeft(brick.level));
  });
}

/**
 * Returns the weight of a probe with these visibility distances, for a position `from` relative to it, in
 * cells.
 */
function visibilityOf(visibility, from) {
  const byte = (word, shift) => float(word.shiftRight(uint(shift)).bitAnd(uint(255)));
  const pairs = [[byte(visibility.x, 0), byte(visibility.x, 8)], [byte(visibility.x, 16), byte(visibility.x, 24)], [byte(visibility.y, 0), byte(visibility.y, 8)]];
  const cells = float(uint(4).shiftLeft(visibility.y.shiftRight(uint(16)).bitAnd(uint(3))));
  const passed = AXES.map((axis, a) => {
    const root = from[axis].greaterThan(0).select(pairs[a][1], pairs[a][0]).div(255);
    return from[axis].abs().div(cells.mul(root).mul(root).max(1e-18));
  }).reduce((largest, term) => largest.max(term)).toVar();
  const behind = passed.sub(0.8).div(1.03 - 0.8).clamp(0, 1).toVar();
  return behind.mul(behind).mul(behind.mul(-2).add(3)).oneMinus().max(float(1e-4).div(passed.clamp(1, 16).pow(8)));
}

/** Returns the eight probes around a position: { texel, weights }. */
function findProbes(tables, position, normal) {
  const { spacing, size, first, bricks } = tables;
  const most = vec3(...size.map((n) => 4 * spacing * n));
  const cellOf = (level) => float(uint(1).shiftLeft(uint(level))).mul(spacing);
  const brick = { first: ivec3(...first.slice(0, 3)).toVar(), level: int(first[3]).toVar(), slot: int(0).toVar() };
  const inside = position.clamp(vec3(0), most).toVar();
  findBrick(tables, inside, brick);
  const seen = inside.add(normal.mul(cellOf(brick.level).mul(0.25))).clamp(vec3(0), most).toVar();
  findBrick(tables, seen, brick);
  const at = seen.sub(vec3(brick.first).mul(4 * spacing)).div(cellOf(brick.level)).toVar();
  const within = at.clamp(vec3(0), vec3(4)).toVar();
  const low = ivec3(within).min(ivec3(3)).toVar();
  const over = within.sub(vec3(low)).toVar();
  const from = at.sub(vec3(low)).toVar();
  const slots = ivec3(brick.slot.mod(int(bricks[0])), brick.slot.div(int(bricks[0])).mod(int(bricks[1])), brick.slot.div(int(bricks[0] * bricks[1])));
  const least = low.add(slots.mul(SIDE)).toVar();
  const weights = CORNERS.map((corner) => {
    const trilinear = AXES.map((axis, a) => (corner[a] ? over[axis] : over[axis].oneMinus())).reduce((product, term) => product.mul(term));
    const visibility = uvec2(tables.visibility(least.add(ivec3(...corner))).xy).toVar();
    return trilinear.mul(visibilityOf(visibility, from.sub(vec3(...corner)))).toVar();
  });
  const sum = weights.reduce((total, weight) => total.add(weight)).toVar();
  return { least, weights: weights.map((weight) => weight.div(sum).toVar()) };
}

/** Returns the coefficients of incident light at a position. */
function incidentOf(tables, position, normal) {
  const { least, weights } = findProbes(tables, position, normal);
  const { light, bricks, coefficients } = tables;
  const numbers = Array.from({ length: Math.ceil((3 * coefficients) / 4) }, (_, plane) =>
    CORNERS.map(([x, y, z], i) => texel(light, least.add(ivec3(x, y, z + SIDE * bricks[2] * plane))).mul(weights[i]))
      .reduce((sum, term) => sum.add(term))
      .toVar(),
  );
  const number = (n) => numbers[n >> 2]["xyzw"[n & 3]];
  return Array.from({ length: coefficients }, (_, o) => vec3(number(3 * o), number(3 * o + 1), number(3 * o + 2)));
}

/** Returns the radiance in unit direction `n` of light with factor `bands[l]` for band l. */
function incidentSum(light, n, bands) {
  const { x, y, z } = n;
  const [xx, yy, zz] = [x.mul(x), y.mul(y), z.mul(z)];
  const basis = [
    [float(0.282094792)],
    [y.mul(-0.488602512), z.mul(0.488602512), x.mul(-0.488602512)],
    [x.mul(y).mul(1.092548431), y.mul(z).mul(-1.092548431), zz.mul(3).sub(1).mul(0.315391565), x.mul(z).mul(-1.092548431), xx.sub(yy).mul(0.546274215)],
    [
      y.mul(xx.mul(3).sub(yy)).mul(-0.59004359),
      x.mul(y).mul(z).mul(2.890611442),
      y.mul(zz.mul(5).sub(1)).mul(-0.457045799),
      z.mul(zz.mul(5).sub(3)).mul(0.373176333),
      x.mul(zz.mul(5).sub(1)).mul(-0.457045799),
      z.mul(xx.sub(yy)).mul(1.445305721),
      x.mul(xx.sub(yy.mul(3))).mul(-0.59004359),
    ],
  ];
  const sums = basis.slice(0, Math.sqrt(light.length)).map((values, l) =>
    values.map((value, m) => light[l * l + m].mul(value)).reduce((sum, term) => sum.add(term)).mul(bands[l]),
  );
  return sums.reduce((sum, term) => sum.add(term)).max(0);
}

/** Returns factors of the bands for mirrored light at this roughness. */
function blurredBands(roughness) {
  const a = roughness.mul(roughness).toVar();
  const even = mix(vec3(1), vec3(2 / 3, 0.25, 0), a);
  const less = vec3(0.231, 0.783, 1.658).add(vec3(0.065, -0.108, -0.78).mul(a));
  const kept = even.sub(less.mul(a).mul(a.oneMinus())).toVar();
  return [float(1), kept.x, kept.y, kept.z];
}

const COSINE = [1, 2 / 3, 1 / 4, 0];

/**
 * Returns the light of a pixel drawn with a material of `volume`: { irradianceOverPi(normal),
 * mirrored(normal, roughness, environment) }; directions are in camera space. `environment`: null without
 * one.
 */
export function lightOfVolume(volume) {
  const { uniforms } = volume;
  const toVolume = uniform(uniforms.prtToVolume.value);
  const sky = uniformArray(uniforms.prtSkyLight.value, "vec3");
  const rotated = mat3(toVolume);
  const towards = (direction) => rotated.mul(direction.transformDirection(cameraViewMatrix)).normalize().toVar();
  const point = toVolume.mul(vec4(positionWorld, 1)).xyz.toVar();
  const light = incidentOf(tablesOf(volume), point, rotated.mul(normalWorldGeometry).normalize());
  const open = light.map((_, o) => sky.element(o));
  return {
    irradianceOverPi: (normal) => incidentSum(light, towards(normal), COSINE).toVar(),
    mirrored: (normal, roughness, environment) => {
      const direction = towards(mix(positionViewDirection.negate().reflect(normal), normal, roughness.mul(roughness)).normalize());
      const bands = blurredBands(roughness);
      const here = incidentSum(light, direction, bands).toVar();
      if (!environment) return here;
      const alone = incidentSum(open, direction, bands).toVar();
      const share = here.div(alone.max(1e-6)).min(1).toVar();
      const sharp = environment.mul(share).add(here.sub(alone).max(0));
      return mix(here, sharp, share.x.min(share.y).min(share.z));
    },
  };
}
