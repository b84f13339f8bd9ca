// A whole study on the page, with the pen, down to the report of the desk's own program.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import crypto from 'node:crypto';
import fs from 'node:fs';
import net from 'node:net';
import path from 'node:path';
import test from 'node:test';
import {frames, openBrowser, pen, report, started, touch} from './browser.mjs';
import {at, key, makeFolder, open, protocol, startDesk, stored, stroke, tiny, until, uploads} from './study.mjs';

const options = {skip: process.env.PALPA ? false : 'no palpa of the desktop'};
const palpa = (...args) => execFileSync(process.env.PALPA, args, {encoding: 'utf8'});
const palpaJson = (...args) => JSON.parse(palpa(...args, '--json'));
const table = (text) => {
    const [header, ...lines] = text.trimEnd().split('\n').map((line) => line.split('\t'));
    return lines.map((cells) => Object.fromEntries(header.map((name, i) => [name, cells[i]])));
};

// A desk with the test's protocol, and a page.
async function withDesk(work, {protocols, size = {}, more = () => []} = {}) {
    const where = makeFolder(protocols);
    const browser = await openBrowser(size);
    const desk = await startDesk(where, 0, more(where));
    // what is asked of a desk that is gone, and the service worker of a certificate that nobody vouches for
    const expected = /^Failed to load resource|SSL certificate error/;
    try {
        await work(browser, desk, where);
        assert.deepEqual(browser.errors.filter((text) => !expected.test(text)), []);
    } finally {
        await browser.close();
        await desk.end();
        where.remove();
    }
}

const tap = async (browser, x, y) => {
    await pen(browser, 'mouseMoved', x, y, 0);
    await pen(browser, 'mousePressed', x, y, 0.4);
    await frames(browser.page, 3);
    await pen(browser, 'mouseReleased', x, y, 0);
    await frames(browser.page, 3);
};
const answersIn = (page) => page.evaluate(() => {
    const files = (folder) => FS.readdir(folder).filter((name) => !name.startsWith('.')).flatMap((name) =>
        FS.isDir(FS.stat(`${folder}/${name}`).mode) ? files(`${folder}/${name}`) : [`${folder}/${name}`]);
    return FS.readFile(files('/studies').find((file) => file.endsWith('ratings_beh.tsv')), {encoding: 'utf8'});
});
const begin = async (page) => {
    await at(page, 'instructions');
    await key(page, 'Enter');
    await at(page, 'trial');
};
// At 1280 x 800 the tissue is 752 px wide from (466, 24).
const runTrial = async (browser, x, y) => {
    await begin(browser.page);
    await stroke(browser, x, y);
    await key(browser.page, 'f');
};
const reload = async (page) => {
    await page.reload();
    await started(page);
    await frames(page, 3);
};
// Questions with the pen and the keyboard of the page: 33 years, right-handed.
const answerQuestions = async (browser) => {
    const {page} = browser;
    await at(page, 'questions');
    await tap(browser, 200, 178);
    await page.keyboard.type('33/');
    await frames(page, 4);
    for (let i = 0; i < 2; ++i) await key(page, 'Enter');
    assert.equal((await report(page)).study.step, 'questions'); // that is no number
    await tap(browser, 200, 178);
    await page.keyboard.press('Control+A');
    await frames(page, 4);
    await page.keyboard.type('33');
    await frames(page, 4);
    await tap(browser, 260, 348);
    await key(page, 'Enter');
};
// What the storage says, while it still has the texts: marks by trial.
const marksOf = (trials) => {
    const out = {};
    for (const trial of trials) {
        if (!trial.text) continue;
        for (const file of JSON.parse(trial.text).files) {
            if (file.name.endsWith('_marks.tsv')) out[path.basename(file.name)] = file.text;
        }
    }
    return out;
};
const marksIn = (study, code) => {
    const folder = path.join(study, `sub-${code}/beh`);
    return Object.fromEntries(fs.readdirSync(folder).filter((name) => name.endsWith('_marks.tsv')).map((name) => [name, fs.readFileSync(path.join(folder, name), 'utf8')]));
};

test('from the menu to the thanks; a reload in the middle of a trial; the desk\'s report has the same marks', options, () => withDesk(async (browser, desk, where) => {
    const {page} = browser;
    await open(browser, desk.url);
    // the way in, by hand
    await tap(browser, 90, 45);
    await tap(browser, 1178, 410);
    await page.waitForFunction(() => document.querySelectorAll('#studies-list label').length === 5);
    await page.check('input[value=short]');
    await page.click('#begin-study');
    await page.waitForURL(/protocol=short/);
    await started(page);

    await at(page, 'code');
    await page.keyboard.type('P7');
    await frames(page, 4);
    await key(page, 'Enter');
    await answerQuestions(browser);
    assert.match(page.url(), /\?protocol=short&participant=P7$/);
    // the desk takes nothing for now, so that the storage keeps the texts
    await page.route('**/api/logs/**', (route) => route.abort());
    await runTrial(browser, 700, 300);             // practice
    await at(page, 'feedback');
    await key(page, 'Enter');
    await begin(page);                             // the first of two, interrupted
    await stroke(browser, 800, 500);
    await page.waitForTimeout(1500);
    await reload(page);
    await at(page, 'again');
    assert.deepEqual((await report(page)).study, {participant: 'P7', step: 'again', finished: 1, of: 3});
    await key(page, 'Enter');
    await runTrial(browser, 935, 243);
    await runTrial(browser, 600, 600);
    await at(page, 'ratings');
    await tap(browser, 375, 195);                  // 4 of 1 to 7
    await key(page, 'Enter');
    await at(page, 'done');
    const where_now = () => page.evaluate(() => palpaTrials.where('P7'));
    assert.equal(await where_now(), 'The trials are on this tablet.');
    const kept = await stored(page);
    const seen = marksOf(kept);
    assert.deepEqual(Object.keys(seen).length, 4);
    const broken = kept.filter((trial) => !trial.finished);
    assert.equal(broken.length, 1);
    const interrupted = JSON.parse(broken[0].text).files;
    assert.ok(interrupted.find((file) => file.name.endsWith('_samples.tsv')).text.split('\n').length > 20);
    assert.ok(!interrupted.find((file) => file.name.endsWith('_events.tsv')).text.includes('\tfinish\t'));

    // who has finished is refused, also after a reload
    await reload(page);
    await at(page, 'code');
    await page.unroute('**/api/logs/**');
    await page.evaluate(() => palpaTrials.send());
    await until('all at the desk', async () => (await stored(page)).every((trial) => trial.sent && trial.text === ''));
    assert.equal(await where_now(), 'The trials are at the desk.');
    const study = path.join(where.folder, 'study');
    const imported = palpaJson('study', 'import', ...uploads(where), '-o', study);
    assert.equal(imported.people_added, 1);
    assert.deepEqual(palpaJson('study', 'import', ...uploads(where), '-o', study).written, []);
    assert.deepEqual(marksIn(study, 'P7'), seen);
    assert.equal(table(fs.readFileSync(path.join(study, 'participants.tsv'), 'utf8'))[0].age, '33');
    assert.equal(table(fs.readFileSync(path.join(study, 'participants.tsv'), 'utf8'))[0].handedness, 'right');
    const out = path.join(where.folder, 'report');
    palpa('study', 'analyse', study, '-o', out);
    const {conditions: {pen: found}, ...counted} = JSON.parse(fs.readFileSync(path.join(out, 'report.json'), 'utf8'));
    assert.deepEqual([counted.trials, counted.practice_trials, counted.interrupted_trials], [2, 1, 1]);
    assert.deepEqual(counted.notes.filter((note) => !note.startsWith('WARNING: fewer than 10 people')), []);
    assert.deepEqual([counted.ratings[0].item, counted.ratings[0].mean], ['effort', 4]);
    const finished = kept.filter((trial) => trial.finished && trial.name.includes('palpation')).slice(1); // without practice
    const marks = Object.values(marksOf(finished)).flatMap(table);
    assert.equal(marks.length, 2);
    assert.equal(found.tp, marks.filter((mark) => mark.hit === '1').length);
    assert.equal(found.fp, marks.filter((mark) => mark.hit === '0').length);
    assert.equal(found.tp, 1);
    // the protocol that was run is the one that the desk served, of a scene that the app does not have
    assert.equal(fs.readFileSync(path.join(study, 'protocol.json'), 'utf8'), fs.readFileSync(path.join(where.assets, 'protocols/short.json'), 'utf8'));
}));

test('ratings that wait on the tablet: the last screen says so until they are at the desk', options, () => withDesk(async (browser, desk, where) => {
    const {page} = browser;
    await open(browser, desk.url, '?protocol=rated&participant=8');
    await runTrial(browser, 700, 300);
    await at(page, 'ratings');
    await until('the trial is at the desk', async () => (await stored(page)).some((trial) => trial.sent && trial.name.includes('palpation')));
    await page.route('**/api/logs/**', (route) => route.abort());
    await tap(browser, 375, 195);
    await key(page, 'Enter');
    await at(page, 'done');
    const said = () => page.evaluate(() => palpaTrials.where('8'));
    await until('the rating waits', async () => (await stored(page)).some((trial) => !trial.sent && trial.name.includes('answers')));
    assert.equal(await said(), 'The trials are at the desk. Answers are still on this tablet.');
    await page.unroute('**/api/logs/**');
    await page.evaluate(() => palpaTrials.send());
    await until('all at the desk', async () => (await stored(page)).every((trial) => trial.sent));
    assert.equal(await said(), 'The trials are at the desk.');
}, {protocols: {rated: {...tiny, ratings: protocol.ratings}}}));

// A key and a certificate of their own, as scripts/run --tablet makes them.
const certificate = ({folder}) => {
    const [key, cert] = ['key.pem', 'cert.pem'].map((name) => path.join(folder, name));
    execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes', '-keyout', key, '-out', cert,
                             '-days', '2', '-subj', '/CN=palpa', '-addext', 'subjectAltName=IP:127.0.0.1'], {stdio: 'ignore'});
    return ['--tls-cert', cert, '--tls-key', key];
};

test('the real desk by https: a wrong code pairs nothing, the right one does; the study comes from the desk after it', options, () => withDesk(async (browser, desk, where) => {
    const {page} = browser;
    await open(browser, desk.url, '?protocol=short&participant=1');
    assert.match(await page.textContent('#message-text'), /protocol: found 'short', expected one of effects softer threshold, or of a desk/);
    await page.click('#leave');
    await page.waitForURL((url) => url.search === '');
    await started(page);
    await page.evaluate(() => palpaPage.openTrials());
    const pairBy = async (code, said) => {
        await page.fill('#code', code);
        await page.click('#pair-now');
        await page.waitForFunction((text) => document.getElementById('trials-state').textContent.includes(text), said);
    };
    await pairBy(desk.code === '000000' ? '000001' : '000000', 'does not accept this code (401)');
    assert.equal(await page.evaluate(() => localStorage.getItem('palpa-token')), null);
    await pairBy(desk.code.slice(0, 3) + desk.code.slice(3), 'Paired with the desk.');
    await open(browser, desk.url, '?protocol=short&participant=1');
    await at(page, 'questions');
    await page.waitForTimeout(1500); // a second Enter at once would not skip the questions
    await key(page, 'Enter');
    await until('the answers are at the desk', () => uploads(where).length === 1);
    await runTrial(browser, 700, 300);
    await until('the trial is at the desk', () => uploads(where).length === 2);
    assert.deepEqual(desk.lines.filter(({event}) => event === 'paired').length, 1);

    // the code of the square; what stood behind # is gone from the address
    await page.evaluate(() => localStorage.removeItem('palpa-token'));
    await open(browser, desk.url, `?protocol=short&participant=1#code=${desk.code}`);
    await until('paired again', async () => (await page.evaluate(() => localStorage.getItem('palpa-token'))) !== null);
    assert.equal(await page.evaluate(() => location.hash), '');
    await reload(page);
    await at(page, 'again');
}, {size: {ignoreHTTPSErrors: true}, more: certificate}));

// Between page and desk: passes on all, or the beginning of an upload and no more.
async function openProxy(port) {
    const proxy = {port, hold: false, held: null};
    const sockets = new Set();
    const server = net.createServer((page) => {
        const desk = net.connect(proxy.port, '127.0.0.1');
        let holds = false;
        sockets.add(page).add(desk);
        page.on('data', (bytes) => {
            if (holds) return;
            holds = proxy.hold && bytes.includes('PUT /api/logs/');
            desk.write(holds ? bytes.subarray(0, 3000) : bytes);
            if (holds) proxy.held();
        });
        desk.pipe(page);
        for (const [one, other] of [[page, desk], [desk, page]]) one.on('error', () => other.destroy()).on('close', () => other.destroy());
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    proxy.url = `http://127.0.0.1:${server.address().port}/`;
    proxy.close = () => { for (const socket of sockets) socket.destroy(); server.close(); };
    return proxy;
}

test('the desk is killed in the middle of an upload and started again: everything arrives once', options, () => withDesk(async (browser, desk, where) => {
    const {page} = browser;
    const proxy = await openProxy(desk.port);
    let second = null;
    try {
        await open(browser, proxy.url, '?protocol=short&participant=2');
        await at(page, 'questions');
        await page.waitForTimeout(1500);
        await key(page, 'Enter');
        await until('the answers are at the desk', () => uploads(where).length === 1);
        const cut = new Promise((resolve) => { proxy.held = resolve; });
        proxy.hold = true;
        await runTrial(browser, 700, 300);
        await cut;
        await page.waitForTimeout(300);
        await desk.end('SIGKILL');
        proxy.hold = false;
        assert.equal(uploads(where).length, 1);
        await at(page, 'feedback'); // that was practice; the study goes on meanwhile
        await key(page, 'Enter');
        await runTrial(browser, 800, 500);
        assert.equal((await stored(page)).filter((trial) => !trial.sent).length, 2);
        second = await startDesk(where);
        proxy.port = second.port;
        await page.evaluate(() => palpaTrials.send());
        await until('everything is at the desk', async () => (await stored(page)).filter((trial) => trial.finished).every((trial) => trial.sent));
        assert.equal(uploads(where).length, 3);
        const study = path.join(where.folder, 'study');
        palpa('study', 'import', ...uploads(where), '-o', study);
        const runs = fs.readdirSync(path.join(study, 'sub-2/beh')).filter((name) => name.endsWith('_events.tsv'));
        assert.equal(runs.length, 2);
    } finally {
        proxy.close();
        if (second) await second.end();
    }
}));

test('without a desk: the protocol was kept, two people and a single run are exported, a study in a file of its own', options, () => withDesk(async (browser, desk, where) => {
    const {page} = browser;
    await open(browser, desk.url, '?protocol=tiny&participant=3');
    await at(page, 'instructions');
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.waitForFunction(() => navigator.serviceWorker.controller !== null);
    await desk.end('SIGKILL');
    await reload(page); // program, protocol and scene from what is kept
    for (const x of [600, 700]) {
        if (x === 600) {
            await at(page, 'again');
            await key(page, 'Enter');
        }
        await runTrial(browser, x, 300);
        await at(page, 'done');
        if (x === 700) break;
        await key(page, 'Enter');
        await at(page, 'code');
        await page.keyboard.type('7'); // a slip, and one letter in its place
        await frames(page, 4);
        await page.keyboard.press('Control+A');
        await frames(page, 4);
        await page.keyboard.type('4');
        await page.waitForTimeout(500);
        await key(page, 'Enter');
    }
    assert.match(page.url(), /participant=4$/);
    await open(browser, desk.url);
    await stroke(browser, 800, 400);
    await key(page, 'f');
    await page.waitForTimeout(500);
    const files = [];
    page.on('download', async (download) => {
        const file = path.join(where.folder, download.suggestedFilename());
        await download.saveAs(file);
        files.push(file);
    });
    await page.evaluate(() => palpaTrials.exportAll());
    await until('two files', () => files.length === 2);
    const ofStudy = files.find((file) => path.basename(file).startsWith('palpa-trials-Tiny-'));
    const study = path.join(where.folder, 'study');
    assert.equal(palpaJson('study', 'import', ofStudy, '-o', study).people_added, 2);
    assert.deepEqual(palpaJson('study', 'import', ...files, '-o', study).passed_over.length, 1);
    palpa('study', 'analyse', study, '-o', path.join(where.folder, 'report'));
    const counted = JSON.parse(fs.readFileSync(path.join(where.folder, 'report/report.json'), 'utf8'));
    assert.deepEqual([counted.participants, counted.trials, counted.practice_trials, counted.interrupted_trials], [2, 2, 0, 0]);
}));

// The first of two trials, which the storage does not take.
const trialWithoutRoom = async (browser, desk, offline) => {
    const {page} = browser;
    await open(browser, desk.url, '?protocol=twice&participant=5');
    await begin(page);
    await page.context().setOffline(offline);
    await page.evaluate(() => {
        window.ways = ['put', 'add'].map((way) => [way, IDBObjectStore.prototype[way]]);
        for (const [way] of ways) IDBObjectStore.prototype[way] = () => { throw new DOMException('full', 'QuotaExceededError'); };
    });
    await stroke(browser, 700, 400);
    await key(page, 'f');
    await page.waitForTimeout(800);
};

test('a full storage: the study that is asked for comes from the desk all the same', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await page.addInitScript(() => {
        for (const way of ['put', 'add']) IDBObjectStore.prototype[way] = () => { throw new DOMException('full', 'QuotaExceededError'); };
    });
    await open(browser, desk.url, '?protocol=twice&participant=5');
    await at(page, 'instructions');
}, {protocols: {twice: {...tiny, repeats: 2}}}));

test('texts with the letters and quotation marks of European languages are shown; those of others are refused', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await open(browser, desk.url, '?protocol=europe&participant=5');
    await at(page, 'instructions');
    await page.goto(`${desk.url}?protocol=japan&participant=5`);
    await page.waitForFunction(() => /instructions: found '\u3042', expected letters of the font: Latin letters of Europe/.test(document.getElementById('message-text').textContent));
}, {protocols: {
    europe: {...tiny, instructions: 'Zażółć gęślą jaźń – „Ťuk“ “ğış” ‘Țară’ — 5 €… • »ß«'},
    japan: {...tiny, instructions: '\u3042'},
}}));

test('with a touch screen, Tab goes on to the next question, and each answer stays under its own', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await open(browser, desk.url, '?protocol=asks&participant=5');
    await at(page, 'questions');
    await tap(browser, 200, 178);
    for (const [i, answer] of ['nurse', 'chess', '3', '45'].entries()) {
        if (i > 0) await page.keyboard.press('Tab');
        await frames(page, 12);
        await page.keyboard.type(answer, {delay: 60});
        await frames(page, 12);
    }
    for (let i = 0; i < 2; ++i) await key(page, 'Enter'); // the first ends the typing
    await at(page, 'instructions');
    const answers = await answersIn(page);
    for (const row of ['prof\tnurse', 'hobby\tchess', 'years\t3', 'old\t45']) assert.ok(answers.includes(`n/a\t${row}\n`), answers);
}, {protocols: {asks: {...tiny, demographics: [
    {id: 'prof', text: 'Your profession'}, {id: 'hobby', text: 'Your hobby'},
    {id: 'years', text: 'Years of experience', from: 0, to: 60}, {id: 'old', text: 'Age', from: 0, to: 99},
]}}}));

test('without a touch screen, letters beyond ASCII that a keyboard types stand in the answer', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await open(browser, desk.url, '?protocol=asks&participant=5');
    await at(page, 'questions');
    await tap(browser, 550, 146);
    for (const letter of 'Müłßž') { // as a keyboard sends them; page.keyboard.type() sends none of their keys
        for (const type of ['keyDown', 'keyUp'])
            await browser.devtools.send('Input.dispatchKeyEvent', {type, key: letter, text: type === 'keyDown' ? letter : undefined, code: 'KeyM'});
        await frames(page, 4);
    }
    for (let i = 0; i < 2; ++i) await key(page, 'Enter'); // the first ends the typing
    await at(page, 'instructions');
    const answers = await answersIn(page);
    assert.ok(answers.includes('n/a\tname\tMüłßž\n'), answers);
}, {size: {touch: false}, protocols: {asks: {...tiny, demographics: [{id: 'name', text: 'A name'}]}}}));

test('a browser that stores nothing is refused a study, in words', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await page.addInitScript(() => { IDBFactory.prototype.open = () => { throw new Error('refused'); }; });
    await page.goto(`${desk.url}?protocol=twice&participant=5`);
    await page.waitForFunction(() => document.getElementById('message-text').textContent.includes('This browser stores nothing'));
    await page.click('#leave');
    await started(page); // the app without a study
    assert.ok((await report(page)).problems.some((text) => text.includes('cannot store trials (refused)')));
}, {protocols: {twice: {...tiny, repeats: 2}}}));

test('the desk does not send all of a study: said for as long as it is on the screen', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await page.addInitScript(() => {
        const real = window.fetch;
        window.fetch = (what, ...rest) => String(what).includes('files/scenes/') ? Promise.reject(new Error('cut')) : real(what, ...rest);
    });
    await page.goto(`${desk.url}?protocol=effects&participant=5`);
    await started(page);
    await frames(page, 60);
    assert.ok((await report(page)).problems.some((text) => text.includes('did not send all of it')));
}));

test('a full storage: after a reload the study does not ask again for a trial that the desk has', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await trialWithoutRoom(browser, desk, false);
    await key(page, 'Enter');
    await at(page, 'trial'); // the desk has the first
    assert.equal((await stored(page)).some(({name, finished}) => finished && name.includes('palpation')), false);
    await reload(page);
    await at(page, 'again');
    assert.equal((await report(page)).study.finished, 1);
    assert.equal(await page.evaluate(() => localStorage.getItem('palpa-study')), null); // there was room again
    await reload(page);
    await at(page, 'again');
    assert.equal((await report(page)).study.finished, 1);
}, {protocols: {twice: {...tiny, repeats: 2}}}));

test('a full storage without a desk: the study waits and says so; exporting lets it go on', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await trialWithoutRoom(browser, desk, true); // else the trial goes to the desk, and the study on
    await key(page, 'Enter');
    await key(page, 'Enter'); // no way on
    await key(page, 'Escape'); // takes neither the reason away nor the way on
    await frames(page, 3);
    assert.equal((await report(page)).study.step, 'instructions');
    assert.ok((await report(page)).problems.some((text) => text.includes('storage of this browser is full')));
    const saved = page.waitForEvent('download');
    await page.evaluate(() => palpaTrials.exportAll());
    await saved;
    await frames(page, 3);
    assert.deepEqual((await report(page)).problems, []); // mended
    await key(page, 'Enter');
    await at(page, 'trial');
    // once there is room, the study keeps the exported trial too, and does not ask for it again
    await page.evaluate(() => { for (const [way, real] of ways) IDBObjectStore.prototype[way] = real; });
    await until('kept', async () => (await stored(page)).some((trial) => trial.finished && trial.exported));
    await page.context().setOffline(false);
    await reload(page);
    await at(page, 'again');
    assert.equal((await report(page)).study.finished, 1);
}, {protocols: {twice: {...tiny, repeats: 2}}}));

test('a full storage: after a reload the end still says that a trial is only in the exported file', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await trialWithoutRoom(browser, desk, true);
    await key(page, 'Enter');
    const saved = page.waitForEvent('download');
    await page.evaluate(() => palpaTrials.exportAll());
    await saved;
    await page.context().setOffline(false);
    await reload(page);
    await key(page, 'Enter');
    await begin(page);
    await stroke(browser, 700, 400);
    await key(page, 'f');
    await at(page, 'done');
    await until('sent', async () => (await stored(page)).some((trial) => trial.sent));
    assert.equal(await page.evaluate(() => palpaTrials.where('5')), 'The trials are at the desk or in an exported file.');
}, {protocols: {twice: {...tiny, repeats: 2}}}));

test('answers that are typed in, and forced choices: kept one by one, and counted by the desk', options, () => withDesk(async (browser, desk, where) => {
    const {page} = browser;
    await open(browser, desk.url, '?protocol=hands&participant=6');
    await at(page, 'instructions');
    await key(page, 'Enter');
    await at(page, 'typed'); // no tissue
    await key(page, 't');
    await page.waitForTimeout(300);
    await key(page, 't');
    await key(page, 'Enter');
    await at(page, 'done');
    await until('stored', async () => (await stored(page)).some((trial) => trial.name.includes('palpation')));
    await reload(page);
    await at(page, 'code'); // done
    await open(browser, desk.url, '?protocol=pairs&participant=6');
    await at(page, 'instructions');
    await key(page, 'Enter');
    for (let pair = 0; pair < 2; ++pair) {
        for (let i = 0; i < 2; ++i) {
            await at(page, 'present');
            await key(page, 'Enter');
        }
        await at(page, 'question');
        await key(page, '1');
        if (pair === 0) {
            await page.waitForTimeout(500);
            await reload(page);
            await at(page, 'again');
            assert.equal((await report(page)).study.finished, 1);
            await key(page, 'Enter');
            await at(page, 'instructions');
            await key(page, 'Enter');
        }
    }
    await at(page, 'done');
    await until('all at the desk', async () => (await stored(page)).every((trial) => trial.sent));
    const by = (name) => uploads(where).filter((file) => JSON.parse(JSON.parse(fs.readFileSync(file, 'utf8')).files.find((one) => one.name === 'study.json').text).protocol === name);
    for (const name of ['Hands', 'Pairs']) palpa('study', 'import', ...by(name), '-o', path.join(where.folder, name));
    assert.match(fs.readFileSync(path.join(where.folder, 'Hands/sub-6/beh', fs.readdirSync(path.join(where.folder, 'Hands/sub-6/beh')).find((name) => name.endsWith('_events.tsv'))), 'utf8'), /\tfinish\t/);
    palpa('study', 'analyse', path.join(where.folder, 'Pairs'), '-o', path.join(where.folder, 'report'));
    const {choices} = JSON.parse(fs.readFileSync(path.join(where.folder, 'report/report.json'), 'utf8'));
    assert.equal(JSON.stringify(choices).includes('"n":2'), true, JSON.stringify(choices));
    assert.throws(() => palpa('study', 'import', ...uploads(where), '-o', path.join(where.folder, 'both')), /two studies never share a folder/);
}, {protocols: {
    hands: {name: 'Hands', version: '1', seed: 1, order: 'fixed', conditions: [{id: 'hand', modality: 'hand', nodules: ['A', 'B']}]},
    pairs: {name: 'Pairs', version: '1', seed: 1, order: 'fixed', conditions: [{id: 'force', modality: 'shape-display'}],
            choice: {reference_kPa: 2, comparisons_kPa: [4], repeats: 2}},
}}));

test('a study with a linear tissue is refused in words before anybody begins', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await page.goto(`${desk.url}?protocol=partly&participant=7`);
    await page.waitForFunction(() => document.getElementById('message-text').textContent.includes('cannot be run here'));
    assert.match(await page.textContent('#message-text'), /conditions\[1\] 'live': .* is a linear tissue, which is computed on the desk/);
    assert.deepEqual(await stored(page), []);
    await page.click('#leave');
    await page.waitForURL((url) => url.search === '');
    await started(page);
}, {protocols: {partly: {...protocol, conditions: [...protocol.conditions, {id: 'live', modality: 'pen', scene: 'linear.json'}]}}}));

test('a study with a calibration profile that reads a pen\'s counts is refused in words before anybody begins', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    await page.goto(`${desk.url}?protocol=paper&participant=7`);
    await page.waitForFunction(() => document.getElementById('message-text').textContent.includes('cannot be run here'));
    assert.match(await page.textContent('#message-text'), /conditions\[1\] 'Touchpad': found calibration profile 'bamboo', which reads pressure_raw/);
    assert.deepEqual(await stored(page), []);
}));

test('a finger whose pressure is always the same is refused in a study, until it varies', options, () => withDesk(async (browser, desk, where) => {
    const {page} = browser;
    const press = async (forceOf) => {
        await touch(browser, 'touchStart', [{x: 700, y: 400, force: forceOf(0), id: 1}]);
        for (let i = 1; i <= 60; ++i) {
            await touch(browser, 'touchMove', [{x: 700 + i, y: 400, force: forceOf(i), id: 1}]);
            await frames(page, 1);
        }
        await touch(browser, 'touchEnd', []);
        await frames(page, 3);
    };
    await open(browser, `${desk.url}?protocol=by-finger&participant=7`);
    await begin(page);
    await press(() => 0.5);
    await at(page, 'device');
    await key(page, 'Enter');
    await at(page, 'device'); // not now
    await press((i) => 0.2 + 0.01 * i);
    await key(page, 'Enter');
    await at(page, 'trial');
    await press((i) => 0.2 + 0.01 * i);
    await key(page, 'f');
    await at(page, 'done');
    await until('all is at the desk', () => uploads(where).length === 3); // answers, and two trials
    const trials = uploads(where).map((file) => JSON.parse(fs.readFileSync(file)).files.find(({name}) => name.endsWith('_events.tsv')))
        .filter(Boolean).sort((a, b) => a.name < b.name ? -1 : 1).map(({text}) => text);
    assert.equal(trials.length, 2);
    assert.match(trials[0], /\tno_pressure\t/);
    assert.doesNotMatch(trials[0], /\tfinish\t/);
    assert.match(trials[1], /\tfinish\t/);
}, {protocols: {'by-finger': {...tiny, conditions: [{id: 'finger', modality: 'finger', scene: 'of-the-desk.json'}]}}}));

test('the list of studies knows by their scenes which ones need the desk, and a protocol that is none takes no other from it', options, () => withDesk(async (browser, desk) => {
    const {page} = browser;
    const check = async () => {
        const {studies, said} = await page.evaluate(() => palpaStudies.list());
        const names = studies.map(({name}) => name);
        for (const name of ['typed', 'broken', 'odd', 'softer', 'other']) assert.ok(names.includes(name), `${name} in ${names}`);
        for (const name of ['driven', 'four-displays', 'paper', 'counts']) assert.ok(!names.includes(name), `${name} in ${names}`);
        assert.match(said, /^On the desk's machine only.*Driven/);
    };
    await open(browser, desk.url);
    await check();
    await page.goto(`${desk.url}?protocol=broken&participant=1`);
    await page.waitForFunction(() => document.getElementById('message-text').textContent.includes('cannot be run here'));
    await page.click('#leave');
    await page.waitForURL((url) => url.search === '');
    await started(page);
    await check();
}, {protocols: {
    broken: {...protocol, name: 'Broken', conditions: {a: 1}},
    odd: {name: 'Odd', conditions: [null, 5]},
    typed: {...protocol, name: 'Typed', conditions: [{id: 'pins', modality: 'shape-display', scene: 'default.json'}]},
    counts: {...protocol, name: 'Counts', conditions: [{id: 'pen', modality: 'pen', scene: 'default.json', profile: 'bamboo.json'}]},
    other: {...protocol, name: 'Other', conditions: [{id: 'pad', modality: 'touchpad', scene: 'touchpad.json', profile: 's-pen.json'}]},
    driven: {...protocol, name: 'Driven', conditions: [{id: 'soft', modality: 'tangible', scene: 'block-soft.json'}]},
}}));
