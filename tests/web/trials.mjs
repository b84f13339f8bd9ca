// Trials on the page, and what the browser's storage has of them.

import assert from 'node:assert/strict';
import {frames, pen} from './browser.mjs';

// A press, and the end of the trial.
export async function finishTrial(browser, x = 800) {
    const {page} = browser;
    await pen(browser, 'mouseMoved', x, 400, 0);
    await pen(browser, 'mousePressed', x, 400, 0.3);
    for (let i = 1; i <= 5; ++i) await pen(browser, 'mouseMoved', x + i, 400, 0.3 + 0.05 * i);
    await pen(browser, 'mouseReleased', x, 400, 0);
    await frames(page, 2);
    await page.keyboard.press('f');
    await frames(page, 3);
}

export const stored = (page) => page.evaluate(() => new Promise((done) => {
    const open = indexedDB.open('palpa');
    open.onsuccess = () => {
        const all = open.result.transaction('trials').objectStore('trials').getAll();
        all.onsuccess = () => { open.result.close(); done(all.result); };
    };
}));
export const until = async (what, holds) => {
    for (let i = 0; i < 100; ++i) {
        if (await holds()) return;
        await new Promise((resolve) => setTimeout(resolve, 100));
    }
    assert.fail(`not within 10 s: ${what}`);
};

export async function pairByDialog(page, code) {
    await page.evaluate(() => palpaTrials.open());
    await page.fill('#code', code);
    await page.click('#pair-now');
    await page.waitForFunction(() => document.getElementById('trials-state').textContent.match(/Paired with|does not accept|looks at no code|not reachable/));
    await page.click('#close-trials');
}
