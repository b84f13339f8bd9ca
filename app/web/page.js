// The page around the program: messages, the dialog of trials, working without a network.
'use strict';

const palpaFolder = new URL('.', document.currentScript.src).href;

const palpaPage = (() => {
    const at = (id) => document.getElementById(id);
    for (const element of document.querySelectorAll('[data-word]')) element.textContent = palpaWords[element.dataset.word];
    for (const element of document.querySelectorAll('[data-label]')) element.setAttribute('aria-label', palpaWords[element.dataset.label]);

    let failed = false;
    const fail = (text) => {
        failed = true;
        at('message').hidden = false;
        at('message-text').textContent = palpaFilled(palpaWords.stopped, text);
    };

    // A study that cannot be run here, before anybody has begun with it.
    const refuse = (text) => {
        at('message').hidden = false;
        at('message-text').textContent = palpaFilled(palpaWords.notHere, text);
        at('leave').hidden = false;
        at('leave').focus();
    };
    at('leave').addEventListener('click', () => palpaStudies.leave());

    const started = () => { at('message').hidden = true; };

    // How much of the program and its files has come, in steps of 5 %: over a slow network they take a minute.
    const loaded = {program: 0, data: 0};
    const loading = (what, bytes) => {
        loaded[what] = bytes;
        const percent = Math.floor(20 * (loaded.program + loaded.data) / at('message-text').dataset.bytes) * 5;
        const text = palpaFilled(palpaWords.loadingShare, percent);
        if (failed || at('message').hidden || percent === 0 || percent >= 100 || at('message-text').textContent === text) return;
        at('message-text').textContent = text;
    };

    const show = () => {
        const state = palpaTrials.state();
        at('trials-state').textContent = state.lines.join(' ');
        at('trials-list').replaceChildren(...state.trials.map((trial) => {
            const line = document.createElement('li');
            line.textContent = `${trial.name}: ${trial.words}`;
            return line;
        }));
        at('pair').hidden = !state.asksCode;
        at('send-now').disabled = !state.paired || state.waiting === 0;
        at('export').disabled = state.waiting === 0;
        at('remove').disabled = !state.trials.some((trial) => trial.exported && !trial.sent);
    };

    const openTrials = () => {
        show();
        if (!at('trials').open) at('trials').showModal();
    };

    const openStudies = async () => {
        at('studies-state').textContent = palpaWords.looking;
        at('studies-list').replaceChildren();
        at('begin-study').disabled = true;
        if (!at('studies').open) at('studies').showModal();
        const {studies, said} = await palpaStudies.list();
        at('studies-state').textContent = said;
        at('studies-list').replaceChildren(...studies.map(({name, title, from}) => {
            const line = document.createElement('label');
            const choice = document.createElement('input');
            choice.type = 'radio';
            choice.name = 'study';
            choice.value = name;
            choice.required = true;
            const words = document.createElement('span');
            words.textContent = title;
            const more = document.createElement('small');
            more.textContent = `${name}, ${from}`;
            words.append(document.createElement('br'), more);
            line.append(choice, words);
            return line;
        }));
        at('begin-study').disabled = studies.length === 0;
    };
    at('study').addEventListener('submit', (event) => {
        event.preventDefault();
        palpaStudies.begin(new FormData(at('study')).get('study'), at('study-code').value);
    });
    at('close-studies').addEventListener('click', () => at('studies').close());

    // A tablet's keyboard comes only for a field of the page: one stands over the canvas's own, and what is typed goes there.
    const typing = at('typing');
    const kKeys = {Enter: 13, Tab: 9}; // of platform/window_event.h
    const kSettled_ms = 300;
    let typed_ms = 0;
    const type = (text, x, y, width, height) => {
        const begins = typing.hidden;
        Object.assign(typing.style, {left: `${x}px`, top: `${y}px`, width: `${width}px`, height: `${height}px`});
        if (!begins && (typing.value === text || performance.now() - typed_ms < kSettled_ms)) return;
        typing.value = text;
        if (!begins) return;
        typing.hidden = false;
        typing.focus();
        typing.select();
    };
    const typeEnd = () => {
        typing.hidden = true;
        typing.blur();
    };
    typing.addEventListener('input', () => {
        Module.ccall('palpa_type', null, ['string'], [typing.value]);
        typed_ms = performance.now();
    });
    typing.addEventListener('keydown', (event) => {
        const code = kKeys[event.key];
        if (!code) return;
        if (event.key === 'Tab') {
            event.preventDefault(); // the program goes on to its next field, and this one with it
            typed_ms = 0;
        }
        for (const down of [1, 0]) _palpa_key(down, code, 0, 0, event.shiftKey ? 1 : 0, 0);
    });
    at('canvas').addEventListener('pointerup', () => { if (!typing.hidden) typing.focus(); });

    at('pair').addEventListener('submit', async (event) => {
        event.preventDefault();
        const code = at('code').value.replace(/\s/g, '');
        if (code === '') return; // would count as a wrong one
        await palpaTrials.pair(code);
        at('code').value = '';
        show();
    });
    at('send-now').addEventListener('click', () => palpaTrials.send());
    at('export').addEventListener('click', () => palpaTrials.exportAll());
    at('remove').addEventListener('click', () => {
        if (confirm(palpaWords.removeAsk)) palpaTrials.removeExported();
    });
    at('close-trials').addEventListener('click', () => at('trials').close());
    palpaTrials.onChange(() => { if (at('trials').open) show(); });

    window.addEventListener('error', (event) => {
        const script = event.target && event.target.tagName === 'SCRIPT';
        if (script) fail(palpaWords.notLoaded);
        else if (event.message) fail(event.message);
    }, true);
    window.addEventListener('unhandledrejection', (event) => palpaTrials.tell(String(event.reason && event.reason.message || event.reason)));
    if ('serviceWorker' in navigator) {
        navigator.serviceWorker.register('service_worker.js').catch(() => {}); // then it needs the desk at every start
    }
    return {fail, loading, refuse, started, openTrials, openStudies, type, typeEnd};
})();

// The program is compiled while it comes; on a first visit, a copy of what comes is counted.
const palpaProgram = async (imports) => {
    const response = await fetch(`${palpaFolder}palpa.wasm`);
    if (!response.ok) throw new Error(`${response.status}`);
    const count = async (reader) => {
        for (let bytes = 0;;) {
            const {done, value} = await reader.read();
            if (done) return;
            palpaPage.loading('program', bytes += value.length);
        }
    };
    const kept = 'serviceWorker' in navigator && navigator.serviceWorker.controller;
    if (!kept) count(response.clone().body.getReader()).catch(() => {}); // what breaks off fails below
    return WebAssembly.instantiateStreaming(response, imports);
};

var Module = {
    canvas: document.getElementById('canvas'),
    locateFile: (file) => palpaFolder + file,
    print: (text) => console.log(text),
    printErr: (text) => console.warn(text),
    instantiateWasm: (imports, done) => {
        palpaProgram(imports).then(({instance, module}) => done(instance, module), (error) => {
            console.warn(error);
            palpaPage.fail(palpaWords.notLoaded);
        });
        return {};
    },
    setStatus: (text) => { // what the loader of the files says, in its own words
        const [, bytes] = /\((\d+)\/\d+\)/.exec(text) || [];
        if (bytes) palpaPage.loading('data', Number(bytes));
    },
    onAbort: (what) => palpaPage.fail(String(what)),
    // trials of earlier days are known before the first one of today
    preRun: [() => {
        addRunDependency('trials');
        palpaTrials.start(palpaPage.openTrials).then(() => palpaStudies.start()).then(() => {
            if (palpaTrials.protocol() !== '' && !palpaTrials.stores()) palpaPage.refuse(palpaWords.studyUnstored);
            else removeRunDependency('trials');
        }, (error) => palpaPage.fail(error.message));
    }],
};
