// Measures three.js in a headless browser with the same model on the same rasteriser, for comparison with bolt-bench.
//   node run.mjs MODEL.glb [--out FILE.json] [--picture FILE.png] [--frames 15] [--size 1280x720] [--angle vulkan]
//                          [--eye X,Y,Z --target X,Y,Z --fov DEG] [--browser chromium]
// Needs `npm ci` in this folder and a Chromium with ANGLE (Debian: chromium). Prints one line of JSON.
import { spawn } from 'node:child_process';
import { createServer } from 'node:http';
import { mkdtemp, readdir, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const folder = dirname(fileURLToPath(import.meta.url));
const text = (value) => ({ type: 'string', default: value });
const { values: given, positionals: [model] } = parseArgs({
    allowPositionals: true,
    options: { out: text(''), picture: text(''), frames: text('15'), size: text('1280x720'), angle: text('vulkan'),
               eye: text('1.1,1.0,1.3'), target: text('0,0.15,0'), fov: text('35'), browser: text('chromium'),
               seconds: text('240') },
});
if (!model) {
    console.error('usage: node run.mjs MODEL.glb [options]; see the head of the file');
    process.exit(2);
}

const numbers = (list, separator) => list.split(separator).map(Number);
const options = { size: numbers(given.size, 'x'), frames: Number(given.frames), eye: numbers(given.eye, ','),
                  target: numbers(given.target, ','), fov_deg: Number(given.fov) };
const types = { '.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript', '.json': 'application/json' };

async function body(request) {
    const parts = [];
    for await (const part of request) parts.push(part);
    return Buffer.concat(parts);
}

// Returns the CPU time of the browser's process group in ms (proc(5): user and system time).
async function cpu_of(group) {
    let ticks = 0;
    for (const id of await readdir('/proc')) {
        if (!/^\d+$/.test(id)) continue;
        const stat = await readFile(`/proc/${id}/stat`, 'utf8').catch(() => '');
        const fields = stat.slice(stat.lastIndexOf(')') + 2).split(' ');
        if (Number(fields[2]) === group) ticks += Number(fields[11]) + Number(fields[12]);
    }
    return 10 * ticks;
}

// Maps a request to a file. The server offers only the page, three.js and the model, and only to this machine.
function file_of(path) {
    if (path === '/model.glb') return model;
    if (path === '/page.html' || path === '/page.mjs') return join(folder, path);
    if (path.startsWith('/three/')) return join(folder, 'node_modules', normalize(path));
    return undefined;
}

let finish;
const finished = new Promise((done) => { finish = done; });
const server = createServer(async (request, response) => {
    const path = new URL(request.url, 'http://localhost').pathname;
    if (request.method === 'POST') {
        const bytes = await body(request);
        response.end();
        if (path === '/picture' && given.picture) await writeFile(given.picture, bytes);
        if (path === '/result') finish(JSON.parse(bytes.toString()));
        return;
    }
    try {
        const bytes = path === '/options.json' ? JSON.stringify(options)
            : path === '/cpu' ? String(await cpu_of(browser.pid)) : await readFile(file_of(path));
        response.setHeader('Content-Type', types[extname(path)] ?? 'application/octet-stream');
        response.end(bytes);
    } catch {
        response.statusCode = 404;
        response.end();
    }
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));

const profile = await mkdtemp(join(tmpdir(), 'bolt-peer-'));
const browser = spawn(given.browser, [
    '--headless=new', '--no-sandbox', '--no-first-run', '--disable-extensions', '--disable-background-networking',
    '--ignore-gpu-blocklist', '--enable-unsafe-swiftshader', '--use-gl=angle', `--use-angle=${given.angle}`,
    '--disable-gpu-watchdog', '--disable-frame-rate-limit', `--user-data-dir=${profile}`, `--window-size=${options.size}`,
    `http://127.0.0.1:${server.address().port}/page.html`], { stdio: ['ignore', 'ignore', 'pipe'], detached: true });
let log = '';
browser.stderr.on('data', (part) => { log = (log + part).slice(-8000); });
browser.on('error', (problem) => finish({ problem: String(problem) }));
browser.on('exit', (code) => finish({ problem: `the browser ended with ${code}` }));
const late = setTimeout(() => finish({ problem: `no result in ${given.seconds} s` }), 1000 * Number(given.seconds));

const result = await finished;
clearTimeout(late);
try { process.kill(-browser.pid, 'SIGKILL'); } catch { /* already ended */ }
server.closeAllConnections();
server.close();
await rm(profile, { recursive: true, force: true, maxRetries: 5 }).catch(() => {});

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
if (!result.problem)
    for (const name of ['shadow_each_frame', 'shadow_kept'])
        Object.assign(result, { [`${name}_median_ms`]: median(result[`${name}_ms`]),
                                [`${name}_best_ms`]: Math.min(...result[`${name}_ms`]) });
console.log(JSON.stringify(result));
if (given.out) await writeFile(given.out, JSON.stringify(result, null, 1) + '\n');
if (result.problem) {
    console.error(log);
    process.exit(1);
}
