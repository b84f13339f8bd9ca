// Pen and fingers of a real browser, down to the rows of the log.

import assert from 'node:assert/strict';
import test from 'node:test';
import {frames, openBrowser, openDesk, pen, report, rows, started, touch, withPage} from './browser.mjs';

const near = (found, expected, tolerance) => assert.ok(Math.abs(found - expected) <= tolerance, `${found}, expected ${expected}`);
const pressing = (all) => all.filter((row) => row.phase === 'down' || row.phase === 'move');

test('pen: pressures 0.1 to 0.9 reach force, depth and avatar', () => withPage({}, async (browser) => {
    const {page} = browser;
    await pen(browser, 'mouseMoved', 800, 400, 0);
    await pen(browser, 'mousePressed', 800, 400, 0.1);
    for (let i = 1; i <= 9; ++i) await pen(browser, 'mouseMoved', 800 + 5 * i, 400, i / 10);
    await pen(browser, 'mouseReleased', 845, 400, 0);
    await frames(page, 2);
    const all = (await rows(page)).filter((row) => row.tool === 'pen');
    assert.equal(all[0].phase, 'hover');
    assert.equal(all.at(-1).phase, 'up');
    const touching = pressing(all);
    assert.equal(touching.length, 10);
    touching.slice(1).forEach((row, i) => near(Number(row.pressure), (i + 1) / 10, 1e-6));
    for (let i = 3; i < 10; ++i) {
        assert.ok(Number(touching[i].force_N) > Number(touching[i - 1].force_N));
        assert.ok(Number(touching[i].depth_mm) > Number(touching[i - 1].depth_mm));
        assert.ok(Number(touching[i].x_mm) > Number(touching[i - 1].x_mm));
    }
    near(Number(touching[9].avatar_x_mm), Number(touching[9].x_mm) - Number(touching[9].lag_mm), 1e-6);
    // what was there when the trial began is not known, and not guessed
    assert.deepEqual(new Set((await rows(page, 1, 'events')).map((row) => row.device_id)), new Set(['n/a']));
}));

test('two fingers: each has its own pressure; the contact size is what a profile of contact areas reads', () => withPage({profile: 'xoom-finger.json'}, async (browser) => {
    const {page} = browser;
    const at = (i) => [{x: 700 + 3 * i, y: 300, radiusX: 4 + i, radiusY: 4 + i, force: i / 10, id: 1},
                       {x: 900, y: 500 - 3 * i, radiusX: 20 - i, radiusY: 20 - i, force: 1 - i / 10, id: 2}];
    await touch(browser, 'touchStart', at(1));
    for (let i = 2; i <= 9; ++i) await touch(browser, 'touchMove', at(i));
    await touch(browser, 'touchEnd', []);
    await frames(page, 2);
    const all = (await rows(page)).filter((row) => row.tool === 'finger');
    const ids = [...new Set(all.map((row) => row.pointer_id))];
    assert.equal(ids.length, 2);
    const [first, second] = ids.map((id) => pressing(all.filter((row) => row.pointer_id === id)));
    assert.equal(first.length, 9);
    assert.equal(second.length, 9);
    first.forEach((row, i) => near(Number(row.pressure), (i + 1) / 10, 1e-6));
    second.forEach((row, i) => near(Number(row.pressure), 1 - (i + 1) / 10, 1e-6));
    // the first that touches palpates: larger and larger contact, more and more force
    const forces = first.map((row) => Number(row.force_N));
    for (let i = 3; i < 9; ++i) assert.ok(forces[i] > forces[i - 1], forces.join(' '));
}));

test('1,000 samples a second for 10 s: none lost, in order', async () => withPage({}, async (browser) => {
    const {page} = browser;
    await pen(browser, 'mouseMoved', 700, 400, 0);
    await pen(browser, 'mousePressed', 700, 400, 0.2);
    const count = 10000;
    const began = performance.now();
    let sent = 0;
    let answered = 0;
    const answers = [];
    while (sent < count) {
        const due = Math.min(count, Math.floor(performance.now() - began));
        for (; sent < due; ++sent) {
            answers.push(pen(browser, 'mouseMoved', 700 + (sent % 400), 400, 0.2 + 0.5 * sent / count).then(() => { ++answered; }));
        }
        await new Promise((resolve) => setTimeout(resolve, 2));
    }
    await Promise.all(answers);
    const took_s = (performance.now() - began) / 1000;
    await pen(browser, 'mouseReleased', 700, 400, 0);
    await frames(page, 3);
    const moves = (await rows(page)).filter((row) => row.tool === 'pen' && row.phase === 'move');
    const {frame_cpu_ms: cpu, frames: drawn} = await report(page);
    console.log(`${moves.length} of ${count} moves in ${took_s.toFixed(1)} s, ${drawn} frames, CPU per frame besides drawing ` +
                `${cpu.p50.toFixed(2)} ms (99 %: ${cpu.p99.toFixed(2)} ms)`);
    assert.equal(moves.length, count);
    moves.forEach((row, i) => assert.ok(Math.abs(Number(row.pressure) - (0.2 + 0.5 * i / count)) < 1e-4, `row ${i}: ${row.pressure}`));
    const times = moves.map((row) => Number(row.t_device_s));
    for (let i = 1; i < count; ++i) assert.ok(times[i] >= times[i - 1]);
}));

test('a press that starts on a panel reaches no tissue; a tap on Finish finishes', () => withPage({}, async (browser) => {
    const {page} = browser;
    await touch(browser, 'touchStart', [{x: 290, y: 578, force: 0.5, id: 1}]);
    await frames(page, 3);
    await touch(browser, 'touchEnd', []);
    await frames(page, 3);
    assert.equal((await report(page)).trials.at(-1).finished, true);
    const all = await rows(page, 1);
    assert.equal(all.filter((row) => row.tool === 'finger' && row.phase !== 'ui').length, 0);
}));

test('a touch that the system cancels (a palm) ends with cancel', () => withPage({}, async (browser) => {
    const {page} = browser;
    await touch(browser, 'touchStart', [{x: 800, y: 400, force: 0.5, id: 1}]);
    await touch(browser, 'touchMove', [{x: 810, y: 400, force: 0.6, id: 1}]);
    await touch(browser, 'touchCancel', []);
    await frames(page, 2);
    const all = (await rows(page)).filter((row) => row.tool === 'finger');
    assert.deepEqual(all.map((row) => row.phase), ['down', 'move', 'cancel']);
}));

test('out of sight and back: the press ends, the gap is logged, nothing runs away', () => withPage({}, async (browser) => {
    const {page} = browser;
    const hide = (hidden) => page.evaluate((value) => {
        Object.defineProperty(document, 'hidden', {configurable: true, get: () => value});
        document.dispatchEvent(new Event('visibilitychange'));
    }, hidden);
    await pen(browser, 'mouseMoved', 800, 400, 0);
    await pen(browser, 'mousePressed', 800, 400, 0.5);
    await pen(browser, 'mouseMoved', 810, 400, 0.5);
    await frames(page, 2);
    await hide(true);
    await page.waitForTimeout(3000);
    await hide(false);
    await pen(browser, 'mouseReleased', 810, 400, 0);
    await pen(browser, 'mousePressed', 800, 400, 0.5);
    await pen(browser, 'mouseMoved', 805, 400, 0.5);
    await pen(browser, 'mouseReleased', 805, 400, 0);
    await frames(page, 2);
    const events = await rows(page, 1, 'events');
    assert.deepEqual(events.map((row) => row.trial_type), ['start', 'hidden', 'shown']);
    assert.ok(Number(events[2].onset) - Number(events[1].onset) > 2.9);
    const phases = (await rows(page)).filter((row) => row.tool === 'pen').map((row) => row.phase);
    assert.deepEqual(phases.filter((phase) => phase !== 'hover'), ['down', 'move', 'cancel', 'down', 'move', 'up']);
    assert.equal((await report(page)).trials.at(-1).finished, false);
}));
