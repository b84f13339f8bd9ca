// No trial is lost on a tablet: storage, the desk, export, reload, no network.

import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import crypto from 'node:crypto';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import {frames, openBrowser, pen, report, site, started, withPage} from './browser.mjs';
import {finishTrial, pairByDialog, stored, until} from './trials.mjs';

const sha256 = (text) => crypto.createHash('sha256').update(text).digest('hex');

test('a finished trial is in the storage before the next begins, whole, and outlives a reload', () => withPage({}, async (browser) => {
    const {page} = browser;
    await finishTrial(browser);
    await until('stored', async () => (await stored(page)).length === 1);
    await page.keyboard.press('r');
    await frames(page, 4);
    const [trial] = await stored(page);
    assert.equal(trial.finished, true);
    assert.equal(sha256(trial.text), trial.sha256);
    const packed = JSON.parse(trial.text);
    assert.equal(packed.palpa_bundle, 1);
    assert.match(packed.files[0].name, /^sub-(tablet[0-9a-f]{8})\/beh\/sub-\1_task-palpation_run-01_/);
    const endings = packed.files.map((file) => file.name.replace(/.*_run-01/, ''));
    for (const ending of ['_events.tsv', '_marks.tsv', '_samples.tsv', '_settings.json', '_performance.json']) assert.ok(endings.includes(ending), ending);
    for (const file of packed.files) assert.equal(sha256(file.text), file.sha256);
    const samples = packed.files.find((file) => file.name.endsWith('_samples.tsv')).text.trimEnd().split('\n');
    assert.equal(samples.filter((row) => row.includes('\tmove\t')).length, 5);
    assert.ok(packed.files.find((file) => file.name.endsWith('_events.tsv')).text.includes('\tfinish\t'));
    assert.equal((await report(page)).trials.length, 2);

    await page.reload();
    await started(page);
    await frames(page, 2);
    assert.deepEqual((await stored(page)).filter((t) => t.finished), [trial]);
    await finishTrial(browser);
    await until('another name', async () => new Set((await stored(page)).filter((t) => t.finished).map((t) => t.name)).size === 2);
}));

test('paired: trials go to the desk; one with another hash is kept and sent again; a wrong code pairs nothing', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    const asked = [];
    page.on('request', (request) => { if (request.url().endsWith('/api/pair')) asked.push(request.postData()); });
    await page.evaluate(() => palpaTrials.open());
    for (const empty of ['', '  ']) {
        await page.fill('#code', empty);
        await page.click('#pair-now'); // says nothing
    }
    await page.click('#close-trials');
    await pairByDialog(page, '111111');
    assert.deepEqual(asked, ['{"code":"111111"}']);
    await page.evaluate(() => { location.hash = 'code=222222'; }); // a square of another desk, or of yesterday
    await until('said', async () => (await report(page)).problems.some((text) => text.includes('does not accept')));
    await finishTrial(browser);
    await until('stored', async () => (await stored(page)).length === 1);
    assert.equal(desk.logs.size, 0);
    desk.locked_s = 31;
    await pairByDialog(page, desk.code);
    assert.match(await page.textContent('#trials-state'), /looks at no code for 31 s/);
    desk.locked_s = 0;
    desk.wrong = true;
    await pairByDialog(page, desk.code);
    await page.evaluate(() => palpaTrials.send());
    const [kept] = await stored(page);
    assert.equal(kept.sent, false);
    assert.ok(kept.text.length > 1000);
    desk.wrong = false;
    await page.evaluate(() => palpaTrials.send());
    await until('sent', async () => (await stored(page))[0].sent);
    assert.equal(desk.logs.size, 1);
    assert.equal(desk.logs.get(kept.name).toString(), kept.text);
    await page.keyboard.press('r');
    await frames(page, 4);
    await finishTrial(browser);
    await until('the second, by itself', () => desk.logs.size === 2);
}));

test('a pairing that has ended is told, the code can be typed again, and a study of the app is not taken for the desk\'s', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    await pairByDialog(page, desk.code);
    await page.reload();
    await started(page);
    await page.evaluate(() => palpaTrials.open());
    assert.equal(await page.isVisible('#code'), false);
    desk.token = 'of-another-desk';
    await page.goto(`${desk.url}?protocol=effects&participant=1`);
    await started(page);
    await until('told', async () => (await report(page)).problems.some((text) => text.includes('was not paired with the desk')));
    await page.evaluate(() => palpaTrials.open());
    assert.ok(await page.isVisible('#code'));
    assert.match(await page.textContent('#trials-state'), /Pair it again/);
}));

test('the desk is gone: trials wait, also over a restart without a network, and arrive when it is back', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.waitForFunction(() => navigator.serviceWorker.controller !== null);
    await pairByDialog(page, desk.code);
    desk.reachable = false;
    await finishTrial(browser);
    await until('stored', async () => (await stored(page)).length === 1);
    await page.reload();
    await started(page); // from the cache alone
    await frames(page, 3);
    assert.ok((await report(page)).frames > 0);
    assert.equal((await stored(page)).filter((t) => t.finished && !t.sent).length, 1);
    desk.reachable = true;
    await page.evaluate(() => palpaTrials.send());
    await until('sent', async () => (await stored(page)).some((t) => t.finished && t.sent));
    assert.equal(desk.logs.size, 1);
}));

test('exported trials are deleted, those at the desk keep their names and count; a trial ended early is called interrupted', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    await pairByDialog(page, desk.code);
    await finishTrial(browser);
    await until('at the desk', async () => (await stored(page)).some((t) => t.sent));
    desk.reachable = false;
    await page.keyboard.press('r');
    await frames(page, 4);
    await pen(browser, 'mousePressed', 700, 400, 0.4);
    await pen(browser, 'mouseReleased', 700, 400, 0);
    await frames(page, 2);
    await page.keyboard.press('m');
    await frames(page, 2);
    await page.keyboard.press('r');
    await frames(page, 4);
    await page.keyboard.press('Enter'); // ends it
    await until('kept', async () => (await stored(page)).filter((t) => t.finished).length === 2);
    const words = () => page.evaluate(() => palpaTrials.state().trials.map((t) => t.words));
    assert.ok((await words()).includes('interrupted, waiting'), String(await words()));
    const where = () => page.evaluate(() => palpaTrials.where(palpaTrials.participant()));
    assert.match(await where(), /^Some trials are on this tablet/);
    await page.evaluate(() => palpaTrials.open());
    await page.click('#export');
    await until('exported', async () => (await words()).includes('interrupted, waiting, exported'));
    page.once('dialog', (dialog) => dialog.accept());
    await page.click('#remove');
    await until('deleted', async () => (await stored(page)).filter((t) => t.finished).length === 1);
    assert.match((await page.evaluate(() => palpaTrials.state().lines)).join(' '), /^0 waiting, 1 at the desk\./);
    assert.equal(await where(), 'The trials are at the desk or in an exported file.');
}));

test('a full storage is said at once, the next trial waits, export saves it and lets it begin', () => withPage({}, async (browser) => {
    const {page} = browser;
    await page.evaluate(() => {
        for (const way of ['put', 'add']) IDBObjectStore.prototype[way] = () => { throw new DOMException('full', 'QuotaExceededError'); };
    });
    await finishTrial(browser);
    await until('said', async () => (await report(page)).problems.some((text) => text.includes('storage of this browser is full')));
    await page.keyboard.press('r');
    await frames(page, 4);
    assert.equal((await report(page)).trials.length, 1); // none has begun
    const saved = page.waitForEvent('download');
    await page.evaluate(() => palpaTrials.open());
    await page.click('#export');
    const file = path.join(fs.mkdtempSync(path.join(os.tmpdir(), 'palpa-export-')), 'export.json');
    await (await saved).saveAs(file);
    await page.click('#close-trials');
    await until('the next trial', async () => (await report(page)).trials.length === 2);
    assert.match(await page.evaluate(() => palpaTrials.note()), /^All trials are at the desk or exported/); // none is stored here
    const {palpa_bundle: version, files} = JSON.parse(fs.readFileSync(file));
    assert.equal(version, 1);
    assert.equal(files.length, 8);
    for (const {sha256: told, text} of files) assert.equal(sha256(text), told);
    fs.rmSync(path.dirname(file), {recursive: true});
}));

test('what the browser has removed is said at the next start', () => withPage({}, async (browser) => {
    const {page} = browser;
    await finishTrial(browser);
    await until('stored', async () => (await stored(page)).length === 1);
    await page.evaluate(() => new Promise((done) => {
        const open = indexedDB.open('palpa');
        open.onsuccess = () => {
            const cleared = open.result.transaction('trials', 'readwrite');
            cleared.objectStore('trials').clear();
            cleared.oncomplete = () => { open.result.close(); done(); };
        };
    }));
    await page.reload();
    await started(page);
    await frames(page, 3);
    assert.ok((await report(page)).problems.some((text) => text.includes('the browser has deleted them')));
}));

test('a trial that is going on when the page goes out of sight is kept, and counts as interrupted', () => withPage({}, async (browser) => {
    const {page} = browser;
    await pen(browser, 'mouseMoved', 800, 400, 0);
    await pen(browser, 'mousePressed', 800, 400, 0.3);
    await pen(browser, 'mouseMoved', 805, 400, 0.4);
    await frames(page, 2);
    await page.evaluate(() => {
        Object.defineProperty(document, 'hidden', {configurable: true, get: () => true});
        document.dispatchEvent(new Event('visibilitychange'));
    });
    await until('stored', async () => (await stored(page)).length === 1);
    const [trial] = await stored(page);
    assert.equal(trial.finished, false);
    assert.ok(trial.text.includes('\\tmove\\t'));
}));

test('a second tab does not start beside the first', () => withPage({quiet: true}, async (browser, desk) => {
    const second = await browser.context.newPage();
    await second.goto(desk.url);
    await second.waitForFunction(() => document.getElementById('message').textContent.includes('another tab'), null, {timeout: 20000});
}));

test('a second tab does not start beside the first without locks either, which plain http from another host has not', () =>
    withPage({quiet: true}, async (browser, desk) => {
        await browser.context.addInitScript(() => Object.defineProperty(navigator, 'locks', {value: undefined}));
        const pages = [];
        for (let i = 0; i < 2; ++i) {
            pages.push(await browser.context.newPage());
            await pages[i].goto(desk.url);
            if (i === 0) await started(pages[0]);
        }
        await pages[1].waitForFunction(() => document.getElementById('message').textContent.includes('another tab'), null, {timeout: 20000});
    }));

test('a browser that refuses locks and storage is no second tab: the app runs, and says that nothing is stored', () =>
    withPage({quiet: true}, async (browser, desk) => {
        await browser.context.addInitScript(() => {
            const refuse = () => { throw new DOMException('refused', 'SecurityError'); };
            Object.defineProperty(navigator, 'locks', {value: {request: async () => refuse()}});
            IDBFactory.prototype.open = refuse;
        });
        const page = await browser.context.newPage();
        await page.goto(desk.url);
        await started(page);
        await until('said', async () => (await report(page)).problems.some((text) => text.includes('cannot store trials (refused)')));
    }));

test('the real desk: a trial goes from the page into a folder of logs', {skip: process.env.PALPA ? false : 'no palpa of the desktop'}, async () => {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'palpa-desk-'));
    const collected = path.join(folder, 'collected');
    const desk = spawn(process.env.PALPA, ['serve', '--collect', collected, '--web', site, '--port', '0', '--json'], {stdio: ['ignore', 'pipe', 'inherit']});
    const browser = await openBrowser();
    try {
        const lines = [];
        desk.stdout.on('data', (text) => lines.push(...String(text).split('\n').filter(Boolean)));
        await until('the desk listens', () => lines.length > 0);
        const {page} = browser;
        await page.goto(JSON.parse(lines[0]).urls[0]);
        await started(page);
        await frames(page, 2);
        await finishTrial(browser);
        const uploads = () => fs.existsSync(collected) ? fs.readdirSync(collected).filter((name) => name.endsWith('.upload')) : [];
        await until('the trial is at the desk', () => uploads().length === 1);
        await until('the tablet knows', async () => (await stored(page)).every((trial) => trial.sent && trial.text === ''));
        const study = path.join(folder, 'study');
        const imported = () => JSON.parse(execFileSync(process.env.PALPA, ['study', 'import', path.join(collected, uploads()[0]), '-o', study, '--json']));
        assert.equal(imported().written.length, 8);
        assert.equal(imported().already_there.length, 8);
        const subject = fs.readdirSync(study).find((name) => name.startsWith('sub-tablet'));
        const events = fs.readFileSync(path.join(study, subject, 'beh', `${subject}_task-palpation_run-01_events.tsv`), 'utf8');
        assert.match(events, /\tfinish\t/);
    } finally {
        await browser.close();
        desk.kill('SIGTERM');
        await new Promise((resolve) => desk.exitCode === null ? desk.once('exit', resolve) : resolve());
        fs.rmSync(folder, {recursive: true});
    }
});
