// Draws test models by WebGLRenderer, and reads back what the plug-in draws beside the picture: renderers.mjs asks.
import { FloatType, PerspectiveCamera, Scene, WebGLRenderer, WebGLRenderTarget } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin, ShLight } from "../../src/PrtkitLoader.js";

const renderer = new WebGLRenderer({ antialias: false });
renderer.setSize(64, 48, false);

const load = (url) => new GLTFLoader().register((parser) => new PrtkitPlugin(parser)).loadAsync(url);

function camera() {
  const seen = new PerspectiveCamera(40, 4 / 3, 0.1, 20);
  seen.position.set(1.5, 3, 5);
  seen.lookAt(0, 0.4, 0);
  return seen;
}

/** The bytes that a texture has on the device. */
function bytesOf(texture, { width, height }) {
  const gl = renderer.getContext();
  const frame = gl.createFramebuffer();
  const bytes = new Uint8Array(4 * width * height);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, renderer.properties.get(texture).__webglTexture, 0);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  gl.deleteFramebuffer(frame);
  renderer.resetState();
  return [...bytes];
}

function pixelsOf(target, { width, height }) {
  const pixels = new (target.texture.type === FloatType ? Float32Array : Uint16Array)(4 * width * height);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
  return [...pixels];
}

/** Of a model with lightmaps: the bytes of its words, and the radiance of its texels, in half floats and in floats. */
async function texels({ model, light, lamps }) {
  const { scene, userData } = await load(model);
  const { prtkit } = userData;
  let drawn = 0;
  const { pass } = prtkit.maps;
  const draw = pass.draw.bind(pass);
  pass.draw = (...options) => (++drawn, draw(...options));
  prtkit.setLight(ShLight.fromCoefficients(prtkit.order, light), 0, null, lamps);
  const shown = new Scene().add(scene);
  const picture = () => {
    const target = new WebGLRenderTarget(64, 48, { type: FloatType });
    renderer.setRenderTarget(target);
    renderer.render(shown, camera());
    renderer.setRenderTarget(null);
    return pixelsOf(target, target);
  };
  const first = picture();
  const [once, second] = [drawn, picture()];
  const maps = prtkit.maps.maps.map((map, i) => {
    const { target } = [...prtkit.maps.targets.values()].find((other) => other.map === map);
    const floats = new WebGLRenderTarget(map.width, map.height, { type: FloatType, depthBuffer: false });
    draw(renderer, floats, map);
    return { i, bytes: map.words.map((texture) => bytesOf(texture, map)), halves: pixelsOf(target, map), floats: pixelsOf(floats, map) };
  });
  const unchanged = drawn;
  prtkit.setLight(ShLight.fromCoefficients(prtkit.order, light.map((value) => 2 * value)), 0, null, lamps);
  picture();
  const doubled = pixelsOf([...prtkit.maps.targets.values()][0].target, maps[0].i === 0 ? prtkit.maps.maps[0] : null);
  prtkit.dispose();
  const again = picture(); // what was disposed of is made again
  return {
    targets: prtkit.maps.targets.size,
    once,
    unchanged,
    afterChange: drawn,
    maps,
    doubled,
    same: first.every((value, k) => value === second[k]) && first.some((value) => value > 0.1 && value !== 1),
    again: again.some((value) => value > 0.1 && value !== 1),
  };
}

globalThis.pictures = { texels };
