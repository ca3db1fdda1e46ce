// Folders of the models and the built page; PRTKIT_WEB overrides them for tests, which use small models.
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const web = fileURLToPath(new URL("../", import.meta.url));
const elsewhere = process.env.PRTKIT_WEB;
const folder = elsewhere ? resolve(elsewhere) : web;
export const publicFolder = join(folder, "public");
export const distFolder = join(folder, "dist");
/** Scenes and bakes while models are made; not served. */
export const workFolder = join(folder, "work");
