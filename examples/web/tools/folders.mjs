// Where models and the built page go: PRTKIT_WEB for tests, which make small ones.
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const web = fileURLToPath(new URL("../", import.meta.url));
const elsewhere = process.env.PRTKIT_WEB;
export const publicFolder = elsewhere ? resolve(elsewhere, "public") : join(web, "public");
export const distFolder = elsewhere ? resolve(elsewhere, "dist") : join(web, "dist");
