// Scenes written by --gltf: gltf_test.mjs PROGRAM MODULES SOURCES; exit status 77: not possible here.
// Oracle: Khronos' validator, and what the report says about the first symmetry.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {mkdtempSync, readdirSync, readFileSync, rmSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join, resolve} from "node:path";

const [program, modules, sources] = process.argv.slice(2).map((path) => resolve(path));
let validator;
try {
  validator = createRequire(join(modules, "x.js"))("gltf-validator");
} catch {
  console.log("skipped: gltf-validator is not installed here");
  process.exit(77);
}
const folder = mkdtempSync(join(tmpdir(), "insym-gltf-"));
try {
  for (const name of readdirSync(join(sources, "examples")).filter((name) => name.endsWith(".step"))) {
    const [scene, report] = [join(folder, "a.glb"), join(folder, "a.json")];
    execFileSync(program, ["detect", join(sources, "examples", name), "--max-tolerance", "1e-6", "--quiet", "--gltf", scene, "--json", report]);
    const bytes = new Uint8Array(readFileSync(scene));
    const {issues, info} = await validator.validateBytes(bytes);
    assert.equal(issues.numErrors + issues.numWarnings, 0, `${name}: ${JSON.stringify(issues.messages.slice(0, 5))}`);
    const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + new DataView(bytes.buffer).getUint32(12, true))));
    const [first] = JSON.parse(readFileSync(report, "utf8")).symmetries;
    const parts = json.nodes.map((node) => node.name);
    assert(parts.includes("model"), name);
    assert.equal(parts.filter((part) => /^cycle \d+ points$/.test(part)).length, first ? first.cycles.length : 0, name);
    assert.equal(parts.some((part) => part.startsWith("empty slots")), Boolean(first && first.missing.length > 0), name);
    assert.equal(parts.includes("model, other half"), Boolean(first && "MZ".includes(first.type)), name);
    console.log(`${name}: ${info.totalTriangleCount} triangles, ${bytes.length} bytes, valid`);
  }
} finally {
  rmSync(folder, {recursive: true});
}
