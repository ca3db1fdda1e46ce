// Runs Khronos' glTF validator on a file: node validate.cjs NODE_MODULES FILE. Exit status: the number of errors.
const fs = require("fs");
const path = require("path");
const validator = require(path.join(process.argv[2], "gltf-validator"));

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[3]))).then((report) => {
  const errors = report.issues.messages.filter((message) => message.severity === 0);
  for (const message of errors) console.log(`${message.code} ${message.pointer}: ${message.message}`);
  if (report.issues.numWarnings > 0)
    for (const message of report.issues.messages.filter((m) => m.severity === 1))
      console.log(`warning ${message.code} ${message.pointer}: ${message.message}`);
  process.exitCode = Math.min(report.issues.numErrors, 99);
});
