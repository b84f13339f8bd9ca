// The parts of the page that are made of HTML, judged by axe-core: all its rules, at the size of a tablet.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import {root, withPage} from './browser.mjs';

const axe = fs.readFileSync(path.join(root, 'build/web-tools/node_modules/axe-core/axe.min.js'), 'utf8');

async function judged(page) {
    const {violations, passes} = await page.evaluate(() => globalThis.axe.run(document));
    assert.ok(passes.length > 10, `${passes.length} rules passed: too few to mean anything`);
    return violations.map(({id, help, nodes}) => `${id}: ${help}: ${nodes.map((node) => node.html).join(' ')}`);
}

const shows = {
    'the app': () => {},
    'the dialog of trials': () => palpaPage.openTrials(),
    'the dialog of studies': () => palpaPage.openStudies(),
    'a study that cannot be run': () => palpaPage.refuse('For a test.'),
    'a program that has stopped': () => palpaPage.fail('for a test'),
    'a field to type in': () => palpaPage.type('42', 100, 100, 200, 40),
};

test('axe-core finds nothing in the parts that are made of HTML', () => withPage({quiet: true}, async ({page}) => {
    await page.evaluate(axe); // by the debugger, which no policy of the page's keeps out
    for (const [name, show] of Object.entries(shows)) {
        await page.evaluate(show);
        assert.deepEqual(await judged(page), [], name);
        await page.evaluate(() => {
            for (const dialog of document.querySelectorAll('dialog')) dialog.close();
            palpaPage.started();
            palpaPage.typeEnd();
        });
    }
}));

test('axe-core would find what is wrong', () => withPage({quiet: true}, async ({page}) => {
    await page.evaluate(axe);
    await page.evaluate(() => {
        const image = document.createElement('img');
        image.src = 'palpa-64.png';
        document.body.append(image);
    });
    assert.match((await judged(page)).join(), /image-alt/);
}));
