// Validates files with the JSON schemas of docs/format.md:
//   node schema.cjs NODE_MODULES FORMAT FILE...
// Prints a line for each .glb: its name, and "right" or the errors, for every prtkit extension of the file at
// the top level, on its nodes, and on its primitives. Exit status: 1 if a file is invalid, 2 if a schema is.
const fs = require("fs");
const path = require("path");
const [modules, format, ...files] = process.argv.slice(2);
const Ajv = require(path.resolve(modules, "ajv/dist/2020"));

const blocks = [...fs.readFileSync(format, "utf8").matchAll(/^```json\n([^]*?)^```$/gm)].map((match) => match[1]);
const schemas = blocks.filter((text) => text.includes('"$schema"')).map((text) => JSON.parse(text));
const ajv = new Ajv({ strictTypes: false, allErrors: true });
let check;
try {
  // all schemas first, because they refer to each other
  for (const schema of schemas) ajv.addSchema(schema, schema.$id ?? schema.title);
  check = new Map(schemas.map(({ $id, title }) => [title, ajv.getSchema($id ?? title)]));
} catch (error) {
  console.log(error.message);
  process.exit(2);
}

/// Returns the errors of a value by the schema of this title; a value without a schema is an error.
function wrong(title, value) {
  const validate = check.get(title);
  if (!validate) return [`the schema '${title}' is missing`];
  return validate(value) ? [] : validate.errors.map(({ instancePath, message }) => `${title}: ${instancePath} ${message}`);
}

const ours = (owner) => Object.entries(owner.extensions ?? {}).filter(([name]) => name.startsWith("PRTKIT_"));

function wrongFile(file) {
  const bytes = fs.readFileSync(file);
  const json = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString("utf8"));
  const primitives = (json.meshes ?? []).flatMap((mesh) => mesh.primitives);
  return [
    ...ours(json).flatMap(([name, value]) => wrong(`${name}, top level`, value)),
    ...(json.nodes ?? []).flatMap(ours).flatMap(([name, value]) => wrong(`${name}, on a node`, value)),
    ...primitives.flatMap(ours).flatMap(([name, value]) => wrong(`${name}, on a primitive`, value)),
  ];
}

for (const file of files) {
  const found = wrongFile(file);
  console.log(`${path.basename(file)}: ${found.length > 0 ? found.join("; ") : "right"}`);
  if (found.length > 0) process.exitCode = 1;
}
