// One HTML file: script and style are put into the page, which names their hashes in its content security policy, so
// that nothing else can run in it or be loaded. The program puts the data where <!--insym:data--> is.
import {createHash} from "node:crypto";
import {defineConfig} from "vite";

const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

function onePage() {
  return {
    name: "one-page",
    enforce: "post",
    generateBundle(_options, bundle) {
      const files = Object.values(bundle);
      const page = files.find((file) => file.fileName.endsWith(".html"));
      const script = files.find((file) => file.type === "chunk").code.trim().replaceAll("</script", "<\\/script");
      const style = files.find((file) => file.fileName.endsWith(".css")).source.trim();
      const policy = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; img-src data: blob:; ` +
        "base-uri 'none'; form-action 'none'";
      page.source = page.source
        .replace(/\s*<script type="module".*?<\/script>/s, "")
        .replace(/\s*<link rel="stylesheet".*?>/s, "")
        .replace("<!--insym:policy-->", () => `<meta http-equiv="Content-Security-Policy" content="${policy}">`)
        .replace("<!--insym:style-->", () => `<style>${style}</style>`)
        .replace("<!--insym:script-->", () => `<script>${script}</script>`);
      page.fileName = "page.html";
      for (const name of Object.keys(bundle)) if (bundle[name] !== page) delete bundle[name];
    },
  };
}

export default defineConfig({
  base: "./",
  build: {
    target: "es2020",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 1e9,
    rollupOptions: {input: "page.html", output: {format: "iife"}},
  },
  plugins: [onePage()],
});
