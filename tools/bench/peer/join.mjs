// Prints a table of our frame times and those of three.js, and writes it as JSON:  node join.mjs THREE.json OURS.json ... OUT.json
import { readFile, writeFile } from 'node:fs/promises';

const read = async (file) => JSON.parse(await readFile(file, 'utf8'));
const [three_file, ...others] = process.argv.slice(2);
const out = others.pop();
const three = await read(three_file);
const runs = (await Promise.all(others.map(read))).flatMap((report) => report.benchmarks);
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

const pairs = [['shadow kept', 'frame_machine/as_peer/manual_time', 'shadow_kept'],
               ['shadow drawn each frame', 'frame_machine/as_peer_shadow_moves/manual_time', 'shadow_each_frame']];
const rows = pairs.map(([what, name, key]) => {
    const ours = runs.filter((run) => run.name === name);
    if (ours.length === 0) throw new Error(`no run of ${name}`);
    const row = { what, ours_median_ms: median(ours.map((run) => run.median_ms)),
                  ours_best_ms: Math.min(...ours.map((run) => run.best_ms)),
                  ours_cpu_ms: Math.min(...ours.map((run) => run.cpu_ms)), three_cpu_ms: three[`${key}_cpu_ms`],
                  three_median_ms: three[`${key}_median_ms`], three_best_ms: three[`${key}_best_ms`] };
    return { ...row, ratio_cpu: row.ours_cpu_ms / row.three_cpu_ms, ratio_median: row.ours_median_ms / row.three_median_ms,
             ratio_best: row.ours_best_ms / row.three_best_ms, spread: ours.map((run) => run.median_ms) };
});
const device = runs[0].label ?? '';
const same = ['llvmpipe', 'SwiftShader'].some((name) => device.includes(name) && three.renderer.includes(name)) ||
    three.renderer.includes(device);
await writeFile(out, JSON.stringify({ device, three: three.three, three_renderer: three.renderer, same_rasteriser: same,
                                      size: three.size, samples: three.samples, triangles: three.triangles, rows }, null, 1) + '\n');

const cell = (value) => String(typeof value === 'number' ? value.toFixed(2) : value).padStart(13);
console.log(`ours: ${device}\nthree.js r${three.three}: ${three.renderer}`);
console.log(`${three.triangles} triangles, ${three.size.join(' x ')}, ${three.samples} samples`);
if (!same) console.log('The rasterisers differ: the ratios are not comparable.');
console.log(`${''.padEnd(24)}${['ours median', 'three median', 'ratio', 'ours best', 'three best', 'ratio', 'ours CPU', 'three CPU', 'ratio'].map(cell).join('')}`);
for (const row of rows) {
    if (Math.max(...row.spread) > 1.2 * Math.min(...row.spread))
        console.log(`The load of the machine changed (our medians: ${row.spread.map(Math.round).join(', ')} ms): compare the CPU times only.`);
    console.log(`${row.what.padEnd(24)}${[row.ours_median_ms, row.three_median_ms, row.ratio_median, row.ours_best_ms,
                                          row.three_best_ms, row.ratio_best, row.ours_cpu_ms, row.three_cpu_ms,
                                          row.ratio_cpu].map(cell).join('')}`);
}
