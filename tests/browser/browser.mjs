// Debian's chromium, headless and without a graphics card, for tests and screenshots.
import {existsSync} from "node:fs";
import {createRequire} from "node:module";

const kChromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find((path) => existsSync(path));

/// `modules`: a folder with node_modules of viewer/package.json. Null where browser or library is missing.
export async function launch(modules) {
  let chromium;
  try {
    ({chromium} = createRequire(`${modules}/x.js`)("playwright-core"));
  } catch {
    return null;
  }
  if (!kChromium) return null;
  return chromium.launch({
    executablePath: kChromium,
    // Tests run as root in containers, where the sandbox cannot; software rendering is asked for by name.
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-dev-shm-usage"],
  });
}
