// Screenshots of pages: shoot.mjs MODULES OUT PAGE... writes OUT/NAME-{desktop,phone}-{light,dark}.png.
// Options before MODULES: --only desktop-light,...  --select N (the N-th symmetry)
import {basename, join, resolve} from "node:path";
import {parseArgs} from "node:util";
import {launch} from "./browser.mjs";

const {values, positionals} = parseArgs({allowPositionals: true, options: {only: {type: "string"}, select: {type: "string"}}});
const [modules, out, ...pages] = positionals;
const browser = await launch(resolve(modules));
if (!browser) {
  console.error("no chromium or no playwright-core");
  process.exit(1);
}
const kSizes = {desktop: {width: 1360, height: 820}, phone: {width: 390, height: 780}};
for (const page of pages)
  for (const [size, viewport] of Object.entries(kSizes))
    for (const colorScheme of ["light", "dark"]) {
      if (values.only && !values.only.split(",").includes(`${size}-${colorScheme}`)) continue;
      const tab = await browser.newPage({viewport, colorScheme, deviceScaleFactor: size === "phone" ? 2 : 1});
      tab.on("console", (message) => console.error(`${page}: ${message.text()}`));
      tab.on("pageerror", (error) => console.error(`${page}: ${error}`));
      await tab.goto(`file://${resolve(page)}`);
      if (values.select) await tab.evaluate((id) => window.insym.select(id), Number(values.select));
      await tab.waitForTimeout(300);
      await tab.screenshot({path: join(out, `${basename(page, ".html")}-${size}-${colorScheme}.png`)});
      await tab.close();
    }
await browser.close();
