// A real desk with a short study, and a page that runs it.

import {spawn} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {frames, pen, report, root, site} from './browser.mjs';

export const until = async (what, holds, seconds = 20) => {
    for (let i = 0; i < 10 * seconds; ++i) {
        if (await holds()) return;
        await new Promise((resolve) => setTimeout(resolve, 100));
    }
    throw new Error(`not within ${seconds} s: ${what}`);
};

// Scene and protocol are the desk's alone: the app has none of that name.
export const protocol = {
    name: 'Short', version: '1', seed: 3, order: 'fixed', time_limit_s: 60, practice: {trials: 1, time_limit_s: 60}, repeats: 2,
    instructions: 'Under this surface there may be harder places. Find them.',
    conditions: [{id: 'pen', title: 'With the pen', modality: 'pen', scene: 'of-the-desk.json'}],
    demographics: [{id: 'age', text: 'How old are you?', from: 18, to: 99}, {id: 'handedness', text: 'Which hand do you write with?', choices: ['left', 'right']}],
    ratings: [{id: 'effort', text: 'It was tiring (1 not at all, 7 very much).', from: 1, to: 7}],
};

// One trial, and nothing else.
export const tiny = {...protocol, name: 'Tiny', practice: undefined, repeats: 1, demographics: undefined, ratings: undefined};

export function makeFolder(protocols = {short: protocol, tiny}) {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'palpa-study-'));
    const assets = path.join(folder, 'assets');
    for (const kind of ['scenes', 'maps', 'profiles', 'phantoms', 'protocols']) {
        fs.cpSync(path.join(root, 'assets', kind), path.join(assets, kind), {recursive: true});
    }
    fs.writeFileSync(path.join(assets, 'scenes/of-the-desk.json'), fs.readFileSync(path.join(assets, 'scenes/default.json'), 'utf8').replace(/"name": "[^"]*"/, '"name": "Of the desk"'));
    for (const [name, json] of Object.entries(protocols)) fs.writeFileSync(path.join(assets, `protocols/${name}.json`), `// of the test\n${JSON.stringify(json)}\n`);
    return {folder, assets, collected: path.join(folder, 'collected'), remove: () => fs.rmSync(folder, {recursive: true, force: true})};
}

// `more`: further options of `palpa serve`.
export async function startDesk({assets, collected}, port = 0, more = []) {
    const desk = spawn(process.env.PALPA, ['serve', '--collect', collected, '--web', site, '--port', String(port), '--json', ...more],
                       {stdio: ['ignore', 'pipe', 'inherit'], env: {...process.env, PALPA_ASSETS: assets}});
    const lines = [];
    let rest = '';
    desk.stdout.on('data', (text) => {
        rest += text;
        const whole = rest.split('\n');
        rest = whole.pop();
        lines.push(...whole.map((line) => JSON.parse(line)));
    });
    const ended = new Promise((resolve) => desk.once('exit', resolve));
    await until('the desk listens', () => lines.length > 0);
    return {...lines[0], url: lines[0].urls[0], lines, end: async (signal = 'SIGTERM') => { desk.kill(signal); await ended; }};
}

export const uploads = ({collected}) => fs.existsSync(collected) ? fs.readdirSync(collected).filter((name) => name.endsWith('.upload')).map((name) => path.join(collected, name)) : [];

// What the browser's storage holds of trials.
export const stored = (page) => page.evaluate(() => palpaTrials.request('readonly', (store) => store.getAll()));

export const at = async (page, step) => {
    await until(`step ${step}`, async () => (await report(page)).study?.step === step);
    await frames(page, 3);
};
export const key = async (page, name) => {
    await page.keyboard.press(name);
    await frames(page, 3);
};

// A stroke over the tissue, a mark at its end.
export async function stroke(browser, x, y) {
    await pen(browser, 'mouseMoved', x, y, 0);
    await pen(browser, 'mousePressed', x, y, 0.3);
    for (let i = 1; i <= 20; ++i) await pen(browser, 'mouseMoved', x + 2 * i, y, 0.3 + 0.02 * i);
    await pen(browser, 'mouseReleased', x + 40, y, 0);
    await frames(browser.page, 2);
    await key(browser.page, 'm');
    await key(browser.page, '4');
}

export async function open(browser, url, query = '') {
    await browser.page.goto(url + query);
    await browser.page.waitForFunction(() => document.getElementById('message').hidden || !document.getElementById('leave').hidden, null, {timeout: 60000});
    await frames(browser.page, 3);
}
