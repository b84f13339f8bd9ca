// The page around the program: messages, the dialog of trials, working without a network.
'use strict';

const palpaFolder = new URL('.', document.currentScript.src).href;

const palpaPage = (() => {
    const at = (id) => document.getElementById(id);

    const fail = (text) => {
        at('message').hidden = false;
        at('message').textContent = 'Palpa has stopped: ' + text;
    };

    const started = () => { at('message').hidden = true; };

    const show = () => {
        const state = palpaTrials.state();
        at('trials-state').textContent = state.lines.join(' ');
        at('trials-list').replaceChildren(...state.trials.map((trial) => {
            const line = document.createElement('li');
            line.textContent = `${trial.name}: ${trial.words}`;
            return line;
        }));
        at('pair').hidden = state.paired;
        at('send-now').disabled = !state.paired || state.waiting === 0;
        at('export').disabled = state.trials.length === 0;
        at('remove').disabled = !state.trials.some((trial) => trial.exported);
    };

    const openTrials = () => {
        show();
        if (!at('trials').open) at('trials').showModal();
    };

    at('pair').addEventListener('submit', async (event) => {
        event.preventDefault();
        await palpaTrials.pair(at('code').value.trim());
        at('code').value = '';
        show();
    });
    at('send-now').addEventListener('click', () => palpaTrials.send());
    at('export').addEventListener('click', () => palpaTrials.exportAll());
    at('remove').addEventListener('click', () => {
        if (confirm('Remove the exported trials from this tablet? The file that was exported is then the only copy.')) palpaTrials.removeExported();
    });
    at('close-trials').addEventListener('click', () => at('trials').close());
    palpaTrials.onChange(() => { if (at('trials').open) show(); });

    window.addEventListener('error', (event) => {
        const script = event.target && event.target.tagName === 'SCRIPT';
        if (script) fail('the program cannot be loaded; is the desk reachable?');
        else if (event.message) fail(event.message);
    }, true);
    if ('serviceWorker' in navigator) {
        navigator.serviceWorker.register('service_worker.js').catch(() => {}); // then it needs the desk at every start
    }
    return {fail, started, openTrials};
})();

var Module = {
    canvas: document.getElementById('canvas'),
    locateFile: (file) => palpaFolder + file,
    print: (text) => console.log(text),
    printErr: (text) => console.warn(text),
    onAbort: (what) => palpaPage.fail(String(what)),
    // trials of earlier days are known before the first one of today
    preRun: [() => {
        addRunDependency('trials');
        palpaTrials.start(palpaPage.openTrials).then(() => removeRunDependency('trials'), (error) => palpaPage.fail(error.message));
    }],
};
