// The page in a browser: page_test.mjs PROGRAM MODULES SOURCES SHARED [TEST...]; exit status 77: not
// possible here.
//
// Oracle: what the page promises. No error, no request, a picture that is not blank and changes with what is chosen;
// the list against the report; every motion ends at the matrix of the report; names are text.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {cpus, loadavg, tmpdir} from "node:os";
import {basename, join, resolve} from "node:path";
import {launch} from "./browser.mjs";

const [program, modules, sources, shared, ...wanted] = process.argv.slice(2);
const browser = await launch(resolve(modules));
if (!browser) {
  console.log("skipped: chromium or playwright-core is not installed here");
  process.exit(77);
}
const folder = mkdtempSync(join(tmpdir(), "insym-page-"));

// The program and the page -------------------------------------------------------------------------

// These have many symmetries even at a small tolerance; the points of their faces are enough to look at.
const kLarge = ["slotted_plate.step", "staggered_connector.step", "Ventilator.stp"];

function makePage(input, ...options) {
  const page = join(folder, `${basename(input)}${options.join("")}.html`);
  const points = kLarge.includes(basename(input)) && !options.includes("--points") ? ["--points", "faces"] : [];
  execFileSync(program, ["detect", input, "--max-tolerance", "1e-6", "--quiet", "--html", page, ...points, ...options]);
  return page;
}

/// The page with its report changed, as another run would have written it.
function withReport(page, change) {
  const text = readFileSync(page, "utf8");
  const parts = text.match(/^(.*<script type="application\/json" id="insym-report">)(.*?)(<\/script>.*)$/s);
  const changed = JSON.stringify(change(JSON.parse(parts[2]))).replaceAll("<", "\\u003c");
  const path = join(folder, `changed-${basename(page)}`);
  writeFileSync(path, parts[1] + changed + parts[3]);
  return path;
}

async function open(path, viewport = {width: 1100, height: 720}) {
  const tab = await browser.newPage({viewport, colorScheme: "light"});
  tab.setDefaultTimeout(120000); // milliseconds; a busy machine is no failure
  tab.wrong = [];
  tab.on("console", (message) => message.type() === "error" && tab.wrong.push(message.text()));
  tab.on("pageerror", (error) => tab.wrong.push(String(error)));
  tab.on("request", (request) => request.url().startsWith("file://") && request.isNavigationRequest() ||
    request.url().startsWith("data:") || tab.wrong.push(`request of ${request.url()}`));
  await tab.goto(`file://${path}`);
  await tab.waitForFunction(() => window.insym);
  return tab;
}

async function close(tab) {
  assert.deepEqual(tab.wrong, []);
  await tab.close();
}

/// What the canvas shows: how many colours, and a number that changes with the picture.
function picture(tab) {
  return tab.evaluate(() => {
    const canvas = document.getElementById("canvas");
    window.insym.stage.draw();
    const copy = Object.assign(document.createElement("canvas"), {width: 200, height: 150});
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0, 200, 150);
    const pixels = new Uint32Array(context.getImageData(0, 0, 200, 150).data.buffer);
    let sum = 0;
    for (const pixel of pixels) sum = (Math.imul(sum, 31) + pixel) | 0;
    return {colours: new Set(pixels).size, sum};
  });
}

const shownIds = (tab) => tab.$$eval(".row", (rows) => rows.map((row) => Number(row.id.slice(4))));
const found = async (tab) => parseInt(await tab.textContent(".found"), 10);
const chosen = (tab) => tab.$eval(".row.selected", (row) => Number(row.id.slice(4)));

// The tests ----------------------------------------------------------------------------------------

async function opensEveryExample() {
  const models = readdirSync(join(sources, "examples")).filter((name) => name.endsWith(".step"))
    .map((name) => join(sources, "examples", name));
  const real = join(shared, "data/Ventilator.stp");
  if (existsSync(real)) models.push(real);
  else console.log(`  ${real} is not there: left out`);
  for (const model of models) {
    const tab = await open(makePage(model, "--limit", "300"));
    const first = await picture(tab);
    assert(first.colours > 20, `${model}: the canvas is blank`);
    const report = await tab.evaluate(() => ({
      symmetries: window.insym.report.symmetries.length, error: window.insym.stage.motionError()}));
    assert(report.error < 1e-5, `${model}: a motion ends ${report.error} from its matrix`);
    assert.equal(await found(tab), report.symmetries);
    if (report.symmetries > 1) {
      await tab.evaluate(() => window.insym.select(2));
      assert.notEqual((await picture(tab)).sum, first.sum, `${model}: choosing changes nothing`);
    }
    await close(tab);
  }
}

/// `counts`: the report's, by a filter written here anew.
async function filters(page) {
  const tab = await open(page);
  const report = await tab.evaluate(() => window.insym.report);
  const count = (holds) => report.symmetries.filter(holds).length;
  await tab.click(".chip.kind-M");
  assert.equal(await found(tab), count((s) => s.type === "M"));
  await tab.click(".chip.kind-C");
  assert.equal(await found(tab), count((s) => s.type === "M" || s.type === "C"));
  await tab.keyboard.press("Escape");
  assert.equal(await found(tab), report.symmetries.length);
  await tab.fill("input[type=search]", "order 8");
  assert.equal(await found(tab), count((s) => String(s.order ?? "").startsWith("8")));
  await tab.fill("input[type=search]", "Rotation, Order 8");
  assert.equal(await found(tab), count((s) => "CS".includes(s.type) && String(s.order ?? "").startsWith("8")));
  await tab.fill("input[type=search]", "nothing of this kind");
  assert.equal(await found(tab), 0);
  await tab.fill("input[type=search]", "");

  // The axis: at a level, those whose interval holds it.
  const slider = await tab.$(".axis input");
  for (const value of [40, 200, 330, 390]) {
    await slider.evaluate((input, to) => {
      input.value = to;
      input.dispatchEvent(new Event("input"));
    }, value);
    const limits = report.symmetries.flatMap((s) => [s.tolerance.min, s.tolerance.max ?? 0]).filter((x) => x > 0);
    const low = report.options.resolution;
    const high = Math.max(...limits, report.options.max_tolerance, 10 * low);
    const level = low * (high / low) ** (value / 400);
    const holding = count((s) => s.tolerance.min <= level && level <= (s.tolerance.max ?? Infinity));
    assert.equal(await found(tab), holding, `at ${level}`);
  }
  await tab.click(".axis button");
  assert.equal(await found(tab), report.symmetries.length);
  await close(tab);
}

async function keyboard(page) {
  const tab = await open(page);
  assert.equal(await chosen(tab), 1);
  await tab.keyboard.press("ArrowDown");
  await tab.keyboard.press("ArrowDown");
  assert.equal(await chosen(tab), 3);
  await tab.keyboard.press("ArrowUp");
  assert.equal(await chosen(tab), 2);
  await tab.keyboard.press("End");
  const last = await chosen(tab);
  assert(last > 20 && (await shownIds(tab)).includes(last), "the last row is not shown");
  await tab.keyboard.press("Home");
  assert.equal(await chosen(tab), 1);
  const before = await picture(tab);
  await tab.keyboard.press("a");
  assert.notEqual((await picture(tab)).sum, before.sum, "looking along the axis changes nothing");
  await tab.keyboard.press("f");
  assert.equal((await picture(tab)).sum, before.sum, "the first view is not as it was");
  await tab.keyboard.press("t");
  assert.equal(await tab.evaluate(() => document.documentElement.dataset.theme), "dark");
  assert.notEqual((await picture(tab)).sum, before.sum, "dark is as light");
  await tab.keyboard.press("t");
  await tab.keyboard.press("Space");
  // A busy machine may take seconds for the first frame.
  let moved = false;
  for (const end = Date.now() + 15_000; !moved && Date.now() < end; moved = (await picture(tab)).sum !== before.sum)
    await tab.waitForTimeout(200);
  assert(moved, "the motion shows nothing");
  await tab.keyboard.press("Space");
  await tab.keyboard.press("/");
  await tab.keyboard.type("mirror");
  const mirrors = await tab.evaluate(() => window.insym.report.symmetries.filter((s) => s.type === "M").length);
  assert((await found(tab)) >= mirrors);
  await tab.keyboard.press("Escape");
  await tab.keyboard.press("?");
  assert(await tab.isVisible("dialog.help"));
  await tab.keyboard.press("Escape");
  await close(tab);
}

async function clickOnAPoint(page) {
  const tab = await open(page);
  const point = await tab.evaluate(() => window.insym.report.symmetries[0].cycles[0].points[0]);
  const at = await tab.evaluate((i) => window.insym.stage.screen(i), point);
  const box = await (await tab.$("#canvas")).boundingBox();
  await tab.mouse.click(box.x + at.x, box.y + at.y);
  const through = await tab.evaluate((i) => {
    const position = (k) => window.insym.stage.screen(k);
    const {symmetries, points} = window.insym.report;
    const counts = new Map();
    points.forEach((_, k) => {
      const away = Math.hypot(position(k).x - position(i).x, position(k).y - position(i).y);
      if (away < 14)
        counts.set(k, symmetries.filter((s) => s.fixed_points.includes(k) || s.cycles.some((c) => c.points.includes(k))).length);
    });
    return [...counts.values()];
  }, point);
  assert(through.includes(await found(tab)), `${await found(tab)} is none of ${through}`);
  assert(await tab.isVisible("#detail .point"));
  await tab.click("#detail .point button");
  assert.equal(await found(tab), await tab.evaluate(() => window.insym.report.symmetries.length));
  // Ids to copy.
  await tab.evaluate(() => Object.defineProperty(navigator, "clipboard", {value: {writeText: (text) => (window.copied = text)}}));
  await tab.click("#detail .buttons button:has-text('copy ids')");
  const copied = await tab.evaluate(() => window.copied.split("\n"));
  const cycles = await tab.evaluate(() => window.insym.report.symmetries[0].cycles.length);
  assert.equal(copied.length, cycles);
  assert.match(copied[0], /^(edge|face|vertex|edges|faces) \d+/);
  await close(tab);
}

async function folding(page) {
  const path = withReport(page, (report) => {
    report.symmetries[4].implied_by = [1];
    report.symmetries[5].implied_by = [5];
    report.symmetries[0].missing = [{position: [0, 0, 0]}];
    return report;
  });
  const tab = await open(path);
  assert.deepEqual((await shownIds(tab)).slice(0, 5), [1, 2, 3, 4, 7]);
  await tab.keyboard.press("ArrowRight");
  assert.deepEqual((await shownIds(tab)).slice(0, 6), [1, 5, 6, 2, 3, 4]);
  await tab.keyboard.press("ArrowDown");
  assert.equal(await chosen(tab), 5);
  await tab.keyboard.press("ArrowLeft");
  assert.deepEqual((await shownIds(tab)).slice(0, 3), [1, 2, 3]);
  await tab.evaluate(() => window.insym.select(1));
  assert.match(await tab.textContent("#detail"), /empty slots1/);
  await close(tab);
}

/// The chart over the tolerance axis, also where a symmetry begins to hold only at the axis' end.
async function chart(page) {
  const path = withReport(page, (report) => {
    report.symmetries[0].tolerance = {min: 10 * report.input.diameter, max: null};
    return report;
  });
  const tab = await open(path);
  const drawn = await tab.$eval(".chart", (canvas) => {
    const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.filter((x, i) => i % 4 === 3 && x > 0).length;
  });
  assert(drawn > 100, `the chart has ${drawn} pixels`);
  await close(tab);
}

/// The flange lacks one of eight holes (examples/README.md): its faces and edges are drawn where they would be. The
/// plate lacks a slot of 4 faces, 12 edges and 8 vertices; the vertices are corners of the edges.
async function ghosts() {
  for (const [example, type, expected] of [
    ["flange", "C", {order: 8, missing: 7, ghosts: 7, rings: 0}],
    ["slotted_plate", "T", {order: null, missing: 24, ghosts: 16, rings: 0}],
  ]) {
    const tab = await open(makePage(join(sources, `examples/${example}.step`), "--points", "representative", "--types", type));
    const slots = await tab.evaluate(() => {
      const first = window.insym.report.symmetries[0];
      return {order: first.order ?? null, missing: first.missing.length, ...window.insym.stage.emptySlots()};
    });
    assert.deepEqual(slots, expected);
    await close(tab);
  }
}

async function phone(page) {
  const tab = await open(page, {width: 380, height: 760});
  assert(await tab.isVisible(".row") && !(await tab.isVisible("#detail dl")));
  await tab.click("#tabs button >> nth=1");
  assert(await tab.isVisible("#detail dl") && !(await tab.isVisible(".row")));
  const wide = await tab.evaluate(() => document.documentElement.scrollWidth);
  assert(wide <= 380, `the page is ${wide} wide`);
  const [canvas, controls] = await Promise.all(["#canvas", ".controls"].map(async (id) => (await tab.$(id)).boundingBox()));
  assert(canvas.y + canvas.height <= controls.y, "the controls hide a part of the model");
  await close(tab);
}

/// 20,000 points and 5,000 symmetries: a grid of points, turns and shifts of it.
function largeReport(report) {
  const side = 100;
  const points = Array.from({length: 2 * side * side}, (_, i) =>
    [i % side, Math.floor(i / side) % side, 20 * Math.floor(i / (side * side))]);
  const row = (y, z) => Array.from({length: side}, (_, x) => x + side * y + side * side * z);
  const symmetries = Array.from({length: 5000}, (_, i) => ({
    id: i + 1, type: "T", order: null,
    isometry: {matrix: [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], angle_deg: 0, step: 1,
      axis: {point: [0, 0, 0], direction: [1, 0, 0]}, plane: null, center: null},
    cycles: i === 0 ? Array.from({length: 200}, (_, k) => ({points: row(k % side, k < side ? 0 : 1), closed: false}))
      : [{points: row(i % side, i % 2), closed: false}],
    tolerance: {min: 1e-3 * (1 + (i % 70)), max: i % 3 === 0 ? null : 0.5 + i / 1000}, deviation: {rms: 0, max: 0},
    coverage: 0.9, fixed_points: [], missing: [], significance: -1000 + i / 10, maximal: true, implied_by: []}));
  return {...report, points, labels: null, entities: null, symmetries, cycles: [],
    input: {...report.input, diameter: 142}, stats: {...report.stats, symmetries: 5000},
    options: {...report.options, resolution: 1e-4, max_tolerance: 1}};
}

async function large() {
  const bare = join(folder, "grid.xyz");
  writeFileSync(bare, "0 0 0\n99 99 20\n99 0 0\n");
  const path = withReport(makePage(bare), largeReport);
  const text = readFileSync(path, "utf8");
  writeFileSync(path, text.replace(/"origin":\[[^\]]*\]/, '"origin":[49.5,49.5,10]'));
  // What other programs take of the machine is not the page's: a busy one gets time in proportion.
  const busy = Math.max(1, loadavg()[0] / cpus().length);
  let tab = null;
  let opened = Infinity;
  for (let i = 0; i < 3 && opened >= 5; ++i) {
    if (tab) await close(tab);
    const start = performance.now();
    tab = await open(path);
    assert((await picture(tab)).colours > 20, "the canvas is blank");
    opened = Math.min(opened, (performance.now() - start) / 1000);
  }
  assert(opened < 5 * busy, `opening took ${opened} s`);
  const frames = await tab.evaluate(() => {
    const times = [];
    for (let i = 0; i < 12; ++i) {
      const from = performance.now();
      window.insym.stage.turn(0.05);
      window.insym.stage.draw();
      const gl = document.getElementById("canvas").getContext("webgl2");
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for the picture
      times.push(performance.now() - from);
    }
    return times.sort((a, b) => a - b);
  });
  console.log(`  20,000 points, 5,000 symmetries: open in ${opened.toFixed(2)} s; ` +
    `a frame takes ${frames[6].toFixed(0)} ms at the median (software rendering), ${frames[11].toFixed(0)} ms at most; ` +
    `load of the machine ${loadavg()[0].toFixed(1)} on ${cpus().length} cores`);
  assert(frames[6] < 500 * busy, `a frame takes ${frames[6]} ms`);
  await tab.keyboard.press("End");
  assert.equal(await chosen(tab), 5000);
  assert((await tab.$$(".row")).length < 60, "the list holds rows that are out of view");
  await close(tab);
}

async function namesAreText() {
  const evil = "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=2>&amp;";
  const model = readFileSync(join(sources, "examples/flange.step"), "latin1");
  const name = model.match(/PRODUCT\('([^']*)'/)[1];
  const inner = join(folder, "<img src=x onerror=hacked=3>");
  mkdirSync(inner);
  const path = join(inner, "<b>&lt;name.step");
  writeFileSync(path, model.replaceAll(`'${name}'`, `'${evil}'`), "latin1");
  const page = join(folder, "evil.html");
  execFileSync(program, ["detect", path, "--max-tolerance", "1e-6", "--quiet", "--html", page]);
  const text = readFileSync(page, "utf8");
  assert.equal(text.match(/<script/g).length - text.match(/<script>[^]*?<\/script>/)[0].match(/<script/g).length, 2);
  const tab = await open(page);
  assert.equal(await tab.textContent("h1"), "<b>&lt;name.step");
  assert.match(await tab.title(), /^<b>&lt;name\.step/);
  const part = await tab.evaluate(() => window.insym.report.entities[0].part);
  assert.equal(part, evil);
  await tab.click("#detail .id");
  assert((await tab.textContent("#detail .point")).includes(evil), "the name is not shown");
  assert.equal(await tab.evaluate(() => window.hacked), undefined);
  assert.deepEqual(tab.wrong, []);
  // Even markup that got in could not run or load anything.
  await tab.evaluate((markup) => {
    document.body.append(Object.assign(document.createElement("script"), {textContent: "window.hacked = 4"}));
    document.body.insertAdjacentHTML("beforeend", markup);
  }, "<img src='https://example.com/x.png' onerror='window.hacked = 5'>");
  await tab.waitForTimeout(200);
  assert.equal(await tab.evaluate(() => window.hacked), undefined);
  assert(tab.wrong.some((text) => /Content Security Policy/.test(text)), "the policy did not refuse it");
  await tab.close();
}

async function pointsInThePlane() {
  const path = join(folder, "hexagon.xyz");
  writeFileSync(path, "1 0\n0.5 0.866025\n-0.5 0.866025\n-1 0\n-0.5 -0.866025\n");
  const tab = await open(makePage(path));
  const first = await picture(tab);
  assert(first.colours > 20, "the canvas is blank");
  await tab.keyboard.press("End");
  assert.notEqual((await picture(tab)).sum, first.sum);
  assert((await tab.evaluate(() => window.insym.stage.motionError())) < 1e-5);
  await close(tab);
}

try {
  // Of method paper, where nothing is folded: the tests fold what they want folded.
  const flange = makePage(join(sources, "examples/flange.step"), "--method", "paper");
  for (const test of [opensEveryExample, filters, keyboard, clickOnAPoint, folding, chart, ghosts, phone, large, namesAreText, pointsInThePlane]) {
    if (wanted.length > 0 && !wanted.includes(test.name)) continue;
    const start = performance.now();
    await test(flange);
    console.log(`${test.name}: passed in ${((performance.now() - start) / 1000).toFixed(1)} s`);
  }
} finally {
  await browser.close();
  rmSync(folder, {recursive: true});
}
