// A desk that serves the built site, and a browser that visits it.

import crypto from 'node:crypto';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import {createRequire} from 'node:module';

export const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..');
const {chromium} = createRequire(path.join(root, 'build/web-tools/'))('playwright-core');
export const site = process.env.PALPA_SITE ?? path.join(root, 'build/web/site');
const types = {'.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.css': 'text/css', '.svg': 'image/svg+xml',
               '.png': 'image/png', '.webmanifest': 'application/manifest+json'};

// As `palpa serve` sends them.
const strict = {'Content-Security-Policy': "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; " +
    "img-src 'self' data: blob:; connect-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp', 'Cross-Origin-Resource-Policy': 'same-origin',
    'X-Content-Type-Options': 'nosniff', 'Referrer-Policy': 'no-referrer'};

// The site, and what `palpa serve` answers to tablets. `desk.wrong`: it says that it got other bytes; `silent`: it answers
// nothing, and closes nothing; `too_large`: the logs that it does not take; `pairing`: it asks for a code; `collects`: it takes logs;
// `locked_s`: it looks at none for so long.
export async function openDesk() {
    const desk = {code: '246810', token: 'token-of-the-test', logs: new Map(), wrong: false, bytes: 0, reachable: true, silent: false, too_large: () => false, pairing: true, collects: true, locked_s: 0};
    const body = (request) => new Promise((resolve) => {
        const parts = [];
        request.on('data', (part) => parts.push(part));
        request.on('end', () => resolve(Buffer.concat(parts)));
    });
    const answer = (response, status, json) => {
        response.writeHead(status, {'Content-Type': 'application/json'});
        response.end(JSON.stringify(json));
    };
    const server = http.createServer(async (request, response) => {
        const url = new URL(request.url, 'http://desk');
        if (!desk.reachable) return response.destroy();
        if (desk.silent && url.pathname.startsWith('/api/')) return;
        if (url.pathname === '/api/health') return answer(response, 200, {ok: true, pairing: desk.pairing, collects: desk.collects, paired: request.headers.authorization === `Bearer ${desk.token}`});
        if (url.pathname === '/api/files' && request.headers.authorization !== `Bearer ${desk.token}`) return answer(response, 401, {error: 'token'});
        if (url.pathname === '/api/pair') {
            const {code} = JSON.parse(await body(request));
            if (desk.locked_s > 0) {
                response.setHeader('Retry-After', String(desk.locked_s));
                return answer(response, 429, {error: 'too many wrong codes', wait_s: desk.locked_s});
            }
            return code === desk.code ? answer(response, 200, {token: desk.token}) : answer(response, 401, {error: 'another code'});
        }
        if (url.pathname.startsWith('/api/logs/') && request.method === 'PUT') {
            const bytes = await body(request);
            if (desk.pairing && request.headers.authorization !== `Bearer ${desk.token}`) return answer(response, 401, {error: 'token'});
            const sha256 = crypto.createHash('sha256').update(bytes).digest('hex');
            if (!desk.collects) return answer(response, 503, {error: 'no folder'});
            if (desk.too_large(decodeURIComponent(url.pathname))) return answer(response, 413, {error: 'too large'});
            if (desk.wrong) return answer(response, 200, {sha256: '0'.repeat(64)});
            if (request.headers['x-content-sha256'] !== sha256) return answer(response, 400, {error: 'hash'});
            desk.logs.set(decodeURIComponent(url.pathname.slice('/api/logs/'.length)), bytes);
            return answer(response, 201, {sha256});
        }
        const file = path.join(site, url.pathname === '/' ? 'index.html' : url.pathname);
        if (!file.startsWith(site) || !fs.existsSync(file)) return response.writeHead(404).end();
        const bytes = fs.readFileSync(file);
        desk.bytes += bytes.length;
        response.writeHead(200, {...strict, 'Content-Type': types[path.extname(file)] ?? 'application/octet-stream', 'Content-Length': bytes.length});
        response.end(bytes);
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    desk.url = `http://127.0.0.1:${server.address().port}/`;
    desk.close = () => new Promise((resolve) => { server.closeAllConnections(); server.close(resolve); });
    return desk;
}

export async function openBrowser({width = 1280, height = 800, scale = 1, touch = true, ignoreHTTPSErrors = false} = {}) {
    const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'palpa-browser-'));
    const context = await chromium.launchPersistentContext(profile, {
        executablePath: '/usr/bin/chromium', headless: true, timeout: 60000, acceptDownloads: true, ignoreHTTPSErrors,
        viewport: {width, height}, deviceScaleFactor: scale, hasTouch: touch,
        args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
               '--disable-component-update', '--disable-sync'],
    });
    const page = context.pages()[0] ?? await context.newPage();
    const browser = {context, page, errors: []};
    page.on('console', (message) => { if (message.type() === 'error') browser.errors.push(message.text()); });
    page.on('pageerror', (error) => browser.errors.push(String(error)));
    browser.devtools = await context.newCDPSession(page);
    browser.close = async () => {
        await context.close();
        fs.rmSync(profile, {recursive: true, force: true});
    };
    return browser;
}

export const started = (page) => page.waitForFunction(() => document.getElementById('message').hidden, null, {timeout: 60000});
export const report = (page) => page.evaluate(() => JSON.parse(UTF8ToString(_palpa_report())));
export const frames = (page, count) => page.evaluate((n) => new Promise((done) => {
    const next = () => n-- > 0 ? requestAnimationFrame(next) : done();
    next();
}), count);

// A pen of the DevTools protocol.
export const pen = (browser, type, x, y, force, more = {}) => browser.devtools.send('Input.dispatchMouseEvent', {
    type, x, y, force, pointerType: 'pen', clickCount: 1, tiltX: 20, tiltY: -10,
    button: type === 'mouseMoved' && force === 0 ? 'none' : 'left', buttons: type === 'mouseReleased' || force === 0 ? 0 : 1, ...more,
});
export const touch = (browser, type, points) => browser.devtools.send('Input.dispatchTouchEvent', {type, touchPoints: points});

// Rows of a table of run `run`, as the program has written it.
export const rows = async (page, run = 1, table = 'samples') => {
    await page.waitForTimeout(120); // rows are handed over every 80 ms
    await frames(page, 2);
    const ending = `_run-${String(run).padStart(2, '0')}_${table}.tsv`;
    const text = await page.evaluate((end) => {
        const folder = `/logs/sub-${palpaTrials.participant()}/beh`;
        return FS.readFile(`${folder}/${FS.readdir(folder).find((name) => name.endsWith(end))}`, {encoding: 'utf8'});
    }, ending);
    const [header, ...lines] = text.trimEnd().split('\n').map((line) => line.split('\t'));
    return lines.map((cells) => Object.fromEntries(header.map((key, i) => [key, cells[i]])));
};

// A desk and a page on it, for one test; what the page complains about fails it. `settings` are those of last time.
export async function withPage({profile, settings, quiet = false, ...options}, work) {
    const desk = await openDesk();
    const browser = await openBrowser(options);
    try {
        const kept = {...settings, ...(profile ? {profile: `/assets/profiles/${profile}`} : {})};
        if (Object.keys(kept).length > 0) {
            await browser.context.addInitScript((text) => localStorage.getItem('palpa-settings') ?? localStorage.setItem('palpa-settings', text),
                                                JSON.stringify(kept));
        }
        await browser.page.goto(desk.url);
        await started(browser.page);
        await frames(browser.page, 2);
        await work(browser, desk);
        if (!quiet && browser.errors.length > 0) throw new Error(browser.errors.join('\n'));
    } finally {
        await browser.close();
        await desk.close();
    }
}
