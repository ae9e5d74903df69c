// SPDX-License-Identifier: GPL-3.0-or-later
// Joins src/ and the packages into pages, a report's and a live one: node build.mjs PACKAGES REPORT.html LIVE.html
// PACKAGES is the folder with package.json in which `npm ci` ran: never this one, the sources stay clean.
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const [packages, report, live] = process.argv.slice(2).map((path) => resolve(path));
const { build } = createRequire(resolve(packages, 'package.json'))('esbuild');
const source = (name) => fileURLToPath(new URL(`src/${name}`, import.meta.url));

async function join(script, frame, out) {
  const result = await build({
    entryPoints: [source(script)],
    nodePaths: [resolve(packages, 'node_modules')],
    bundle: true,
    minify: true,
    write: false,
    outdir: 'out',
    format: 'iife',
    target: 'es2022',
    legalComments: 'inline',  // the packages' licences ask for their notices
  });
  const text = (ending) => result.outputFiles.find((file) => file.path.endsWith(ending)).text;
  // Functions, because "$" in a replacement text would have a meaning.
  const page = readFileSync(source(frame), 'utf8')
    .replace('@STYLE@', () => text('.css'))
    .replace('@SCRIPT@', () => text('.js'));
  writeFileSync(out, page);
}

await join('main.js', 'page.html', report);
await join('live.js', 'live.html', live);
