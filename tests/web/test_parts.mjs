// Parts in the browser, which has one thread: beams answer at once, and finite cells follow between the frames.

import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import test from 'node:test';
import {frames, pen, started, withPage} from './browser.mjs';

const cached = (page) => page.evaluate(() => {
    const folder = '/home/web_user/.cache/palpa';
    return FS.analyzePath(folder).exists ? FS.readdir(folder).filter((name) => name.endsWith('.cache')).length : 0;
});

// The longest time between two frames of the page, ms, until `done`.
const longestFrame = (page, done) => page.evaluate(async (ending) => {
    const over = new Function(`return ${ending}`)();
    let longest = 0;
    let before = performance.now();
    const began = before;
    while (!over() && performance.now() - began < 60000) {
        const now = await new Promise(requestAnimationFrame);
        longest = Math.max(longest, now - before);
        before = now;
    }
    return longest;
}, done);

test('parts: an edit is answered at once, and its cells are computed while the page goes on', () => withPage({}, async (browser) => {
    const {page} = browser;
    await page.keyboard.press('e');
    await page.waitForFunction(() => FS.analyzePath('/home/web_user/.cache/palpa').exists, null, {timeout: 60000});
    await frames(page, 5);
    const before = await cached(page);
    assert.ok(before >= 1, `${before} responses are kept`);
    // Cut, then a stroke through the upper brush's head
    await pen(browser, 'mouseMoved', 184, 382, 0);
    await pen(browser, 'mousePressed', 184, 382, 0.4);
    await pen(browser, 'mouseReleased', 184, 382, 0);
    await frames(page, 5);
    await pen(browser, 'mouseMoved', 1195, 352, 0);
    await pen(browser, 'mousePressed', 1195, 352, 0.4);
    await pen(browser, 'mouseMoved', 1205, 352, 0.4);
    await pen(browser, 'mouseReleased', 1205, 352, 0);
    const longest = await longestFrame(page, `() => FS.readdir('/home/web_user/.cache/palpa').filter((name) => name.endsWith('.cache')).length > ${before}`);
    console.log(`longest frame while cells were computed: ${longest.toFixed(0)} ms`);
    assert.ok(await cached(page) > before, 'the cells of the edited brush were computed');
}));

test('parts: Ctrl+Y does again what U undid', () => withPage({}, async (browser) => {
    const {page} = browser;
    const done = () => page.evaluate(() => {
        const folder = '/home/web_user/.local/share/palpa/parts';
        const [name] = FS.analyzePath(folder).exists ? FS.readdir(folder).filter((one) => one.endsWith('.json')) : [];
        return name ? JSON.parse(FS.readFile(`${folder}/${name}`, {encoding: 'utf8'})).shape.length : 0;
    });
    await parts(page);
    await tap(browser, 184, 382); // Cut
    await tap(browser, 1195, 352);
    await page.waitForFunction(() => FS.analyzePath('/home/web_user/.local/share/palpa/parts').exists, null, {timeout: 60000});
    const cut = await done();
    await page.keyboard.press('u');
    await frames(page, 5);
    assert.equal(await done(), cut - 1);
    await page.keyboard.press('Control+y');
    await frames(page, 5);
    assert.equal(await done(), cut);
}));

const tap = async (browser, x, y) => {
    await pen(browser, 'mouseMoved', x, y, 0);
    await pen(browser, 'mousePressed', x, y, 0.4);
    await pen(browser, 'mouseReleased', x, y, 0);
    await frames(browser.page, 5);
};
const edits = (page) => page.evaluate(() => {
    const folder = '/home/web_user/.local/share/palpa/parts';
    return FS.analyzePath(folder).exists ? FS.readdir(folder).filter((name) => name.endsWith('.json')) : [];
});
const parts = async (page) => {
    await page.keyboard.press('e');
    await page.waitForFunction(() => FS.analyzePath('/home/web_user/.cache/palpa').exists, null, {timeout: 60000});
    await frames(page, 5);
};

test('parts: an edit outlives a reload, is gone on with, and is saved as a file', () => withPage({}, async (browser) => {
    const {page} = browser;
    await parts(page);
    await tap(browser, 184, 382); // Cut
    await tap(browser, 1195, 352);
    await page.waitForFunction(() => FS.analyzePath('/home/web_user/.local/share/palpa/parts').exists, null, {timeout: 60000});
    assert.deepEqual(await edits(page), ['toothbrush-a-edited.json']);
    await page.waitForTimeout(500); // for the storage
    await page.reload();
    await started(page);
    assert.deepEqual(await edits(page), ['toothbrush-a-edited.json']);
    await parts(page);
    await tap(browser, 184, 586); // Earlier changes
    await frames(page, 30);
    const [download] = await Promise.all([page.waitForEvent('download', {timeout: 60000}), tap(browser, 184, 586)]); // Save a to a file
    assert.equal(download.suggestedFilename(), 'toothbrush-a-edited.json');
    const saved = JSON.parse(await readFile(await download.path(), 'utf8'));
    assert.ok('remove' in saved.shape.at(-1), JSON.stringify(saved.shape.at(-1)));
    assert.deepEqual(await edits(page), ['toothbrush-a-edited.json']);
}));
