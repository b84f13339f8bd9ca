// What goes wrong on a tablet: desks that are silent or refuse, a storage that is full or closed, addresses and keys that
// nobody meant. No trial is lost by it, and the app does not wait for ever.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import test from 'node:test';
import {frames, report, rows, started, withPage} from './browser.mjs';
import {finishTrial, pairByDialog, stored, until} from './trials.mjs';

const soon = (page) => page.waitForFunction(() => document.getElementById('message').hidden, null, {timeout: 20000});
const tellsOf = async (page, text) => (await report(page)).problems.some((problem) => problem.includes(text));
const names = (file) => JSON.parse(fs.readFileSync(file, 'utf8')).files.map(({name}) => name);
// What *Export to one file* writes.
const exported = async (page) => {
    const saved = page.waitForEvent('download', {timeout: 10000});
    await page.evaluate(() => palpaTrials.open());
    await page.click('#export');
    const found = names(await (await saved).path());
    return found;
};
const fillStorage = (page) => page.evaluate(() => {
    window.ways = ['put', 'add'].map((way) => [way, IDBObjectStore.prototype[way]]);
    for (const [way] of ways) IDBObjectStore.prototype[way] = () => { throw new DOMException('full', 'QuotaExceededError'); };
});
const twoTrialsAndRoomForOne = async (browser) => {
    await finishTrial(browser);
    await until('stored', async () => (await stored(browser.page)).length === 1);
    await browser.page.keyboard.press('r');
    await frames(browser.page, 4);
    await fillStorage(browser.page);
    await finishTrial(browser);
};

test('a desk that answers nothing holds up the start for seconds only', () => withPage({quiet: true}, async ({page}, desk) => {
    desk.silent = true;
    await page.reload();
    await soon(page);
}));

test('a desk without a code that was away at the start gets the trials when it is back', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    desk.pairing = false;
    desk.silent = true;
    await page.reload();
    await soon(page);
    await finishTrial(browser);
    await until('stored', async () => (await stored(page)).some(({finished}) => finished));
    desk.silent = false;
    await page.evaluate(() => window.dispatchEvent(new Event('online')));
    await until('at the desk', async () => (await stored(page)).some(({finished, sent}) => finished && sent));
}));

test('a desk that needs no code is asked for none, and one that takes no logs goes on saying so', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    desk.pairing = false;
    desk.collects = false;
    await page.evaluate(() => localStorage.setItem('palpa-token', 'of another desk'));
    await page.reload();
    await started(page);
    await finishTrial(browser);
    await until('stored', async () => (await stored(page)).some(({finished}) => finished));
    await page.evaluate(() => palpaTrials.send());
    await page.evaluate(() => palpaTrials.open());
    assert.match(await page.textContent('#trials-state'), /This desk does not accept logs/);
    assert.doesNotMatch(await page.textContent('#trials-state'), /Paired/);
    assert.equal(await page.isVisible('#pair'), false);
}));

test('a desk that is started again without a folder for logs is not called one that takes them', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    desk.pairing = false;
    await page.reload();
    await started(page);
    await page.evaluate(() => palpaTrials.open());
    assert.match(await page.textContent('#trials-state'), /accepts logs without a code/);
    await page.click('#close-trials');
    desk.collects = false;
    await finishTrial(browser);
    await page.evaluate(() => palpaTrials.open());
    await until('said', async () => /^1 waiting, 0 at the desk\. This desk does not accept logs/.test(await page.textContent('#trials-state')));
    assert.doesNotMatch(await page.textContent('#trials-state'), /accepts logs without|503/);
    desk.collects = true;
    await page.evaluate(() => window.dispatchEvent(new Event('online')));
    await until('at the desk', () => desk.logs.size === 1);
}));

test('a browser that asks whether the page may stay, and gets no answer, starts all the same', () => withPage({quiet: true}, async ({page}) => {
    await page.addInitScript(() => { StorageManager.prototype.persist = () => new Promise(() => {}); });
    await page.reload();
    await soon(page);
}));

test('an upload that nobody answers is given up, and sent again', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    await pairByDialog(page, desk.code);
    await page.evaluate(() => { // a hundred times as fast
        const wait = AbortSignal.timeout;
        AbortSignal.timeout = (ms) => wait.call(AbortSignal, ms / 100);
    });
    desk.silent = true;
    await finishTrial(browser);
    await until('stored', async () => (await stored(page)).length === 1);
    await page.waitForTimeout(2000);
    desk.silent = false;
    await page.evaluate(() => palpaTrials.send());
    await until('at the desk', () => desk.logs.size === 1);
}));

test('a storage without room to say that a stored trial is at the desk holds up no other trial', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    await twoTrialsAndRoomForOne(browser);
    await until('said', () => tellsOf(page, 'is not stored'));
    await pairByDialog(page, desk.code);
    await until('both are at the desk', () => desk.logs.size === 2);
    await page.evaluate(() => palpaTrials.open());
    await until('said', async () => /^0 waiting, 2 at the desk/.test(await page.textContent('#trials-state')));
    assert.doesNotMatch(await page.textContent('#trials-state'), /not reachable/);
}));

test('a trial that the desk does not take holds up no other', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    desk.too_large = (name) => name.includes('run-01');
    await pairByDialog(page, desk.code);
    await finishTrial(browser);
    await page.keyboard.press('r');
    await frames(page, 4);
    await finishTrial(browser);
    await until('the second is at the desk', () => desk.logs.size === 1);
    await page.evaluate(() => palpaTrials.open());
    assert.match(await page.textContent('#trials-state'), /1 waiting, 1 at the desk.*answered 413/);
}));

test('a full storage with trials: export, remove, and it goes on; what was exported is kept too', () => withPage({quiet: true}, async (browser) => {
    const {page} = browser;
    page.on('dialog', (dialog) => dialog.accept());
    await twoTrialsAndRoomForOne(browser);
    await until('said', () => tellsOf(page, 'storage of this browser is full'));
    const found = await exported(page);
    assert.ok(found.some((name) => name.includes('run-01')) && found.some((name) => name.includes('run-02')), found.join());
    await page.evaluate(() => { for (const [way, real] of ways) IDBObjectStore.prototype[way] = real; }); // what is removed makes room
    await page.click('#remove');
    await until('only the second', async () => (await stored(page)).map(({name}) => name.slice(-6)).join() === 'run-02');
    assert.match(await page.textContent('#trials-list'), /run-02: waiting, exported/);
    await page.click('#close-trials');
    await page.keyboard.press('r');
    await until('the next trial', async () => (await report(page)).trials.length === 3);
    assert.deepEqual((await report(page)).problems, []); // what was not stored is now
}));

test('a full storage with a desk: the desk gets the trial, and it goes on', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    await pairByDialog(page, desk.code);
    await fillStorage(page);
    await finishTrial(browser);
    await until('at the desk', () => desk.logs.size === 1);
    await page.evaluate(() => palpaTrials.open());
    await until('said', async () => /0 waiting, 1 at the desk/.test(await page.textContent('#trials-state')));
    assert.match(await page.textContent('#trials-list'), /run-01: at the desk/);
    await page.click('#close-trials');
    await page.keyboard.press('r');
    await until('the next trial', async () => (await report(page)).trials.length === 2);
    await until('nothing to say', async () => (await report(page)).problems.length === 0);
}));

test('the browser closes its storage: what is palpated afterwards can be exported', () => withPage({quiet: true}, async (browser, desk) => {
    const {page} = browser;
    await finishTrial(browser);
    await until('stored', async () => (await stored(page)).length === 1);
    await page.keyboard.press('r');
    await frames(page, 4);
    await browser.devtools.send('Storage.clearDataForOrigin', {origin: new URL(desk.url).origin, storageTypes: 'indexeddb'});
    await until('said', () => tellsOf(page, 'closed its storage'));
    await finishTrial(browser);
    await until('said', () => tellsOf(page, 'is not stored'));
    const found = await exported(page);
    assert.ok(found.length > 0 && found.every((name) => name.includes('run-02')), found.join());
    assert.ok(await tellsOf(page, 'the exported file does not contain them'));
    await page.click('#close-trials');
    await page.keyboard.press('r');
    await until('the next trial', async () => (await report(page)).trials.length === 3);
}));

test('an address whose participant is no code is told; one with an empty protocol asks for no study', () => withPage({quiet: true}, async ({page}, desk) => {
    for (const [query, odd] of [['?participant=Ann%20Lee', 'Ann Lee'], ['?participant=NA', 'NA'], ['?participant=Total', 'Total'], ['?protocol=&participant=', ''], ['?protocol=', null]]) {
        await page.goto(desk.url + query);
        await soon(page);
        await frames(page, 3);
        assert.equal(await tellsOf(page, `the participant '${odd}', expected`), odd !== null, query);
        assert.match((await page.evaluate(() => FS.readdir('/logs').join())), /sub-tablet[0-9a-f]{8}/);
    }
    await page.evaluate(() => localStorage.setItem('palpa-participant', 'all')); // of a time when it was a code
    await page.reload();
    await soon(page);
}));

test('keys belong to the dialog that is open, wherever in it somebody has clicked; a key that is let go there ends its press', () => withPage({}, async (browser) => {
    const {page} = browser;
    await page.evaluate(() => palpaTrials.open());
    await page.click('#trials-state');
    await page.keyboard.press('f');
    await frames(page, 3);
    assert.ok(!(await rows(page, 1, 'events')).some((row) => row.trial_type === 'finish'));
    await page.click('#close-trials');
    await page.keyboard.down('Space');
    await until('the press', async () => (await rows(page)).some((row) => row.phase === 'down'));
    await page.evaluate(() => palpaTrials.open());
    await page.keyboard.up('Space');
    const last = async () => (await rows(page)).map((row) => row.phase).filter((phase) => phase !== 'hover').at(-1);
    await until('the end of the press', async () => /up|cancel/.test(await last()));
}));
