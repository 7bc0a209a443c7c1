// Validates the .glb files that are its arguments; fails on any error or warning.
const fs = require('fs');
const path = require('path');
const validator = require('gltf-validator');

(async () => {
  let failed = false;
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    const { numErrors, numWarnings, numInfos, messages } = report.issues;
    console.log(`${path.basename(file)}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`);
    for (const { severity, code, message, pointer } of messages) {
      // 0 is an error, 1 a warning; the rest is advice.
      if (severity < 2) console.log(`  ${severity} ${code} ${pointer}: ${message}`);
    }
    failed ||= numErrors + numWarnings > 0;
  }
  process.exit(failed ? 1 : 0);
})();
