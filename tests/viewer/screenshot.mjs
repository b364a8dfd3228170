// Opens a log and a layout in Foxglove Studio, in a browser without a window, and saves pictures:
// PICTURE.png, and PICTURE-tab.png with each further tab of plots.
//
// node screenshot.mjs MODULES CHROMIUM RUN.mcap LAYOUT.json TIME_S PICTURE.png

import { createReadStream, readFileSync, statSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import path from "node:path";

// how long a state is waited for: on a busy computer the viewer's 30 MB alone take minutes
const LIMIT_MS = 900_000;
// a picture is taken once two, this far apart, are the same
const STILL_MS = 3_000;
const [modules, browserPath, run, layout, time, picture] = process.argv.slice(2);
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const require = createRequire(path.resolve(modules, "driver.js"));
const puppeteer = require("puppeteer-core");
const { tabs } = JSON.parse(readFileSync(layout)).configById["Tab!tabs"];

const types = { ".html": "text/html", ".js": "text/javascript", ".json": "application/json" };
types[".wasm"] = "application/wasm";

// the viewer reads logs in ranges of bytes
function answer(request, response) {
  const name = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
  const own = { "/": path.join(here, "page.html"), "/run.mcap": run, "/layout.json": layout };
  const file = own[name] ?? path.join(modules, path.normalize(name).replace(/^\/modules/, ""));
  let size;
  try {
    size = statSync(file).size;
  } catch {
    response.writeHead(404).end();
    return;
  }
  const headers = {
    "Accept-Ranges": "bytes",
    "Content-Type": types[path.extname(file)] ?? "application/octet-stream",
  };
  const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? "");
  const start = range ? Number(range[1]) : 0;
  const end = range && range[2] ? Math.min(Number(range[2]), size - 1) : size - 1;
  if (range) headers["Content-Range"] = `bytes ${start}-${end}/${size}`;
  headers["Content-Length"] = end - start + 1;
  response.writeHead(range ? 206 : 200, headers);
  if (request.method === "HEAD") response.end();
  else createReadStream(file, { start, end }).pipe(response);
}

const server = createServer(answer);
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const address = `http://127.0.0.1:${server.address().port}/`;

const browser = await puppeteer.launch({
  executablePath: browserPath,
  // drawn by the processor: there need be no graphics card
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  defaultViewport: { width: 1920, height: 1080 },
  timeout: LIMIT_MS,
  protocolTimeout: LIMIT_MS,
});

// plots fill in while the log is read: saves the page once it has come to rest
async function photograph(page, file) {
  const end = Date.now() + LIMIT_MS;
  let before = null;
  for (;;) {
    const now = Buffer.from(await page.screenshot());
    if (before?.equals(now)) {
      writeFileSync(file, now);
      return;
    }
    if (Date.now() > end) throw new Error(`${file}: the page does not come to rest`);
    before = now;
    await new Promise((done) => setTimeout(done, STILL_MS));
  }
}

try {
  const page = await browser.newPage();
  page.setDefaultTimeout(LIMIT_MS);
  const problems = new Set();
  page.on("pageerror", (error) => problems.add(String(error)));
  page.on("response", (found) => {
    const file = new URL(found.url()).pathname;
    if (found.status() >= 400 && file !== "/favicon.ico") console.log(`not found: ${file}`);
  });
  const at = new Date(1000 * Number(time)).toISOString();
  await page.goto(`${address}?time=${encodeURIComponent(at)}`, { waitUntil: "domcontentloaded" });
  // the panel of raw messages has the last one at the time asked for
  const shown = () => /railpatch\.\w+ @ [\d.]+ sec/.test(document.body.innerText);
  await page.waitForFunction(shown, { polling: 500 });
  // a hint that covers a panel
  for (const button of await page.$$('[role="tooltip"] button')) await button.click();
  await photograph(page, picture);
  const canvases = await page.$$eval("canvas", (found) => found.length);
  console.log(`${picture}: ${canvases} canvases`);
  // the other tabs of plots
  for (const [number, { title }] of tabs.entries()) {
    if (number === 0) continue;
    const tab = await page.$(`input[value="${title}"]`);
    if (!tab) throw new Error(`the viewer shows no tab ${title}`);
    await tab.click();
    const file = picture.replace(/\.png$/, `-${title.toLowerCase()}.png`);
    await photograph(page, file);
    console.log(file);
  }
  for (const problem of problems) console.error(`page: ${problem}`);
  if (problems.size || canvases < 2) process.exitCode = 1;
} finally {
  await browser.close();
  server.close();
}
