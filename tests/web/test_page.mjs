// The page: size of the first visit, settings over a reload, a lost GL context, turning, density.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import {frames, openBrowser, openDesk, pen, report, root, rows, started, touch, withPage} from './browser.mjs';

// What a person sees, pixel by pixel, as 'red,green,blue'.
const coloursOf = async (page, clip) => page.evaluate(async (png) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const canvas = Object.assign(document.createElement('canvas'), {width: image.width, height: image.height});
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const {data} = context.getImageData(0, 0, image.width, image.height);
    return Array.from({length: data.length / 4}, (_, i) => data.slice(4 * i, 4 * i + 3).join());
}, (await page.screenshot({clip})).toString('base64'));

test('the first visit loads less than 3 MB', () => withPage({}, async (browser, desk) => {
    console.log(`${desk.bytes} bytes with the copies that are kept for later`);
    const bytes = await browser.page.evaluate(() => performance.getEntriesByType('resource').concat(performance.getEntriesByType('navigation'))
        .filter((entry) => entry.initiatorType !== 'other').reduce((sum, entry) => sum + entry.decodedBodySize, 0));
    console.log(`${bytes} bytes until it runs, not compressed`);
    assert.ok(bytes > 1e6 && bytes < 3e6, String(bytes));
}));

test('over a slow network the page says how much has come', async () => {
    const desk = await openDesk();
    const browser = await openBrowser();
    try {
        const {page, devtools} = browser;
        await devtools.send('Network.enable');
        await devtools.send('Network.emulateNetworkConditions', {offline: false, latency: 20, downloadThroughput: 1e6, uploadThroughput: 1e6});
        await page.addInitScript(() => {
            // the emulated network is the page's: a service worker would have everything at once
            navigator.serviceWorker.register = () => Promise.reject(new Error('later'));
            window.shares = [];
            addEventListener('DOMContentLoaded', () => {
                const text = document.getElementById('message-text');
                new MutationObserver(() => shares.push(text.textContent)).observe(text, {childList: true});
            });
        });
        await page.goto(desk.url);
        await started(page);
        const shares = (await page.evaluate(() => shares)).map((text) => Number(/^Loading Palpa: (\d+) %$/.exec(text)[1]));
        console.log(shares.join(' '));
        assert.ok(shares.length >= 5 && shares.every((share, i) => share > (shares[i - 1] ?? 0) && share < 100), shares.join());
    } finally {
        await browser.close();
        await desk.close();
    }
});

test('a file that does not come: the page says so, whatever else is still coming', async () => {
    const desk = await openDesk();
    const browser = await openBrowser();
    try {
        const {page} = browser;
        for (const [file, said] of [['palpa.wasm', /cannot be loaded/], ['palpa.data', /palpa\.data/], ['palpa.js', /cannot be loaded/]]) {
            await page.route(`**/${file}`, (route) => route.abort());
            await page.goto(desk.url);
            await page.waitForFunction(() => /^Palpa has stopped/.test(document.getElementById('message-text').textContent));
            await page.waitForTimeout(1000);
            assert.match(await page.textContent('#message-text'), said);
            await page.unroute(`**/${file}`);
            await page.evaluate(async () => {
                for (const registration of await navigator.serviceWorker.getRegistrations()) await registration.unregister();
                for (const name of await caches.keys()) await caches.delete(name);
            });
        }
    } finally {
        await browser.close();
        await desk.close();
    }
});

test('settings outlive a reload', () => withPage({}, async (browser) => {
    const {page} = browser;
    const kept = () => page.evaluate(() => JSON.parse(localStorage.getItem('palpa-settings') ?? '{}'));
    // Menu, Settings, Left: by touch, where they stand at this size
    const tap = async (x, y) => {
        await touch(browser, 'touchStart', [{x, y, force: 0.5, id: 1}]);
        await frames(page, 3);
        await touch(browser, 'touchEnd', []);
        await frames(page, 3);
    };
    await tap(90, 45);
    await tap(840, 45);
    await tap(626, 163);
    assert.equal((await kept()).left_handed, true);
    await page.reload();
    await started(page);
    await frames(page, 3);
    const settings = await page.evaluate(() => FS.readFile('/home/web_user/.config/palpa/settings.json', {encoding: 'utf8'}));
    assert.equal(JSON.parse(settings).left_handed, true);
}));

test('of the keys for screens, the help names those that open one in the browser', () => withPage({quiet: true}, async ({page}) => {
    const words = fs.readFileSync(path.join(root, 'app/screens/words.h'), 'utf8');
    const named = (of) => new RegExp(`${of} = "([^"]*)"`).exec(words)[1].split(', ');
    const seen = async () => {
        await page.waitForTimeout(400);
        const dialogs = await page.evaluate(() => [...document.querySelectorAll('dialog')].filter((dialog) => dialog.open).map(({id}) => id).join());
        return dialogs + (await page.screenshot({clip: {x: 560, y: 60, width: 560, height: 600}})).toString('base64');
    };
    const opening = [];
    for (const key of new Set([...named('kKeyScreens'), ...named('kKeyScreensWeb')])) {
        const before = await seen();
        await page.keyboard.press(key.toLowerCase());
        if (await seen() !== before) opening.push(key);
        await page.keyboard.press('Escape');
    }
    assert.deepEqual(opening.sort(), named('kKeyScreensWeb').sort());
}));

test('a lost GL context comes back with the same picture; samples go on meanwhile', () => withPage({}, async (browser) => {
    const {page} = browser;
    await page.keyboard.press('c'); // text, table, tissue
    await page.keyboard.press('c');
    await frames(page, 4);
    const shot = async () => (await page.screenshot({clip: {x: 460, y: 0, width: 820, height: 800}})).toString('base64');
    const before = await shot();
    await page.evaluate(() => {
        window.lose = Module.canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
        lose.loseContext();
    });
    await page.waitForTimeout(300);
    await pen(browser, 'mouseMoved', 800, 400, 0);
    await pen(browser, 'mousePressed', 800, 400, 0.4);
    await pen(browser, 'mouseMoved', 805, 400, 0.5);
    await pen(browser, 'mouseReleased', 805, 400, 0);
    await frames(page, 3);
    assert.equal((await rows(page)).filter((row) => row.phase === 'move').length, 1);
    assert.notEqual(await shot(), before);
    await page.evaluate(() => lose.restoreContext());
    await page.waitForTimeout(300);
    await pen(browser, 'mouseMoved', 100, 750, 0); // off the tissue, so that nothing stands on it but the place of a mark
    await frames(page, 4);
    const colours = new Set(await coloursOf(page, {x: 460, y: 0, width: 820, height: 800}));
    assert.ok(colours.size > 20, `${colours.size} colours after the context came back`);
}));

test('the tissue is shown as well while nothing moves but the clock', () => withPage({}, async (browser) => {
    const {page} = browser;
    await pen(browser, 'mouseMoved', 800, 400, 0);
    await pen(browser, 'mousePressed', 800, 400, 0.4);
    await pen(browser, 'mouseReleased', 800, 400, 0);
    await pen(browser, 'mouseMoved', 100, 750, 0);
    for (let i = 0; i < 4; ++i) {
        await page.waitForTimeout(800);
        const [red, green, blue] = (await coloursOf(page, {x: 1180, y: 60, width: 8, height: 8}))[0].split(',').map(Number);
        assert.ok(red > 150 && green > 100 && blue > 80, `${red}, ${green}, ${blue} after ${i} looks`);
    }
}));

test('turned and made denser: the drawing area follows, positions stay true, no panel overflows', () => withPage({width: 1280, height: 800, scale: 2}, async (browser) => {
    const {page} = browser;
    const sizes = () => page.evaluate(() => [Module.canvas.width, Module.canvas.height]);
    assert.deepEqual(await sizes(), [2560, 1600]);
    await page.setViewportSize({width: 800, height: 1280});
    await frames(page, 4);
    assert.deepEqual(await sizes(), [1600, 2560]);
    assert.equal((await report(page)).overflow, '');
    // the middle of the tissue is the middle of the map, wherever it is drawn: a press there and one 10 CSS px to the right
    await pen(browser, 'mouseMoved', 400, 1000, 0);
    await pen(browser, 'mousePressed', 400, 1000, 0.4);
    await pen(browser, 'mouseMoved', 410, 1000, 0.5);
    await pen(browser, 'mouseReleased', 410, 1000, 0);
    await frames(page, 2);
    const touching = (await rows(page)).filter((row) => row.phase === 'down' || row.phase === 'move');
    assert.ok(Number(touching[1].x_mm) > Number(touching[0].x_mm));
    assert.ok(Math.abs(Number(touching[1].y_mm) - Number(touching[0].y_mm)) < 1e-9);
}));

test('a linear tissue is refused in words, and the scene before stays', () => withPage({quiet: true, settings: {scene: '/assets/scenes/linear.json'}}, async ({page}) => {
    const {problems, scene} = await report(page);
    assert.ok(problems.some((text) => text.includes('computed on the desk')), problems.join());
    assert.ok(scene.includes('Silicone'));
}));

test('the device check tells levels, rate, size and delay, and the trial\'s log has them', () => withPage({}, async (browser) => {
    const {page} = browser;
    await page.keyboard.press('d');
    await frames(page, 3);
    await pen(browser, 'mouseMoved', 900, 400, 0);
    await pen(browser, 'mousePressed', 900, 400, 0.1);
    for (let i = 0; i < 60; ++i) await pen(browser, 'mouseMoved', 900 + i, 400, 0.1 + i / 100);
    await pen(browser, 'mouseReleased', 960, 400, 0);
    await frames(page, 3);
    const {device_check: {pen: found}} = await report(page);
    assert.equal(found.pressure, 'varies');
    assert.ok(found.distinct_pressures >= 55, String(found.distinct_pressures));
    assert.equal(found.tilt, true);
    assert.ok(found.rate_Hz > 5);
    assert.ok(found.samples_per_delivery >= 1);
    assert.ok(found.delay_ms >= 0 && found.delay_ms < 5000, String(found.delay_ms));
    await page.keyboard.press('Escape');
    await frames(page, 2);
    await page.keyboard.press('f');
    await frames(page, 3);
    const log = await page.evaluate(() => new Promise((done) => {
        const open = indexedDB.open('palpa');
        open.onsuccess = () => {
            const all = open.result.transaction('trials').objectStore('trials').getAll();
            all.onsuccess = () => done(JSON.parse(all.result[0].text).files.find((f) => f.name.endsWith('performance.json')).text);
        };
    }));
    assert.ok(JSON.parse(log).device_check.pen.distinct_pressures >= 55);
}));
