// Images whose pixels contain words of texels, not colours: loaded as textures with the exact bytes of the
// file.

import { LoaderUtils, NearestFilter, Texture } from "three";
import { expect, TEXELS } from "./wholeExtension.js";

/** Returns the bytes of image `i` of a glTF, from its buffers or a separate file. */
async function imageBytes(parser, i) {
  const { bufferView, uri } = parser.json.images[i];
  try {
    if (bufferView !== undefined) return await parser.getDependency("bufferView", bufferView);
    return await parser.fileLoader.loadAsync(LoaderUtils.resolveURL(uri, parser.options.path));
  } catch (error) {
    throw new Error(`${TEXELS}: image ${i} cannot be read`, { cause: error });
  }
}

/** Throws unless `bytes` begin as a PNG of that size does, with 8 bits in each of four channels. */
function checkHeader(bytes, { width, height }, i) {
  const header = bytes.byteLength >= 26 ? new DataView(bytes) : null;
  const isPng = header?.getUint32(0) === 0x89504e47 && header.getUint32(12) === 0x49484452;
  expect(isPng && header.getUint16(24) === 0x0806, `image ${i} is not a PNG with four channels of 8 bits`, TEXELS);
  expect(header.getUint32(16) === width && header.getUint32(20) === height, `image ${i} does not have the size of its map`, TEXELS);
}

async function decoded(bytes, i) {
  expect(typeof createImageBitmap === "function", "createImageBitmap is missing, so images cannot be decoded", TEXELS);
  const asTheyAre = { premultiplyAlpha: "none", colorSpaceConversion: "none", imageOrientation: "none" };
  try {
    return await createImageBitmap(new Blob([bytes], { type: "image/png" }), asTheyAre);
  } catch (error) {
    throw new Error(`${TEXELS}: image ${i} cannot be decoded`, { cause: error });
  }
}

/** Returns a texture of image `i`, for a map of that size. `parser`: of GLTFLoader. */
export async function wordTexture(parser, i, size) {
  const bytes = await imageBytes(parser, i);
  checkHeader(bytes, size, i);
  const texture = new Texture(await decoded(bytes, i));
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.generateMipmaps = texture.flipY = false;
  texture.needsUpdate = true;
  return texture;
}
