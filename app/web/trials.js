// Trials are kept in the browser's storage (IndexedDB) until the desk has said that it has the same bytes.
// A trial: {name, text, sha256, finished, endedEarly, exported, sent}; text is gone once it was sent (docs/tablet.md).
// Beside them: `study`, files that a study goes on from; `parts` of the trial that is going on; `files` of the desk;
// `designs`, part files that a person has changed.
'use strict';

const palpaTrials = (() => {
    const kStores = {trials: 'name', study: 'path', parts: ['name', 'path', 'offset'], files: 'path', designs: 'path'}; // and their keys
    const kAgain_ms = 15000;
    const kAnswer_ms = 500; // of another tab
    const kWait_ms = 3000;   // for another tab, and for a desk at the start
    const kPair_ms = 10000;
    const kSend_ms = 120000; // for an upload
    const kOfOneTrial = [400, 411, 413, 415, 422]; // answers that tell nothing about other trials
    const trials = new Map(); // by name, without texts
    const problems = [];
    const solved = [];         // texts of problems that are none any more
    const told = new Map();    // what was told of a trial that is not stored, by its name; '' for the one that is going on
    const unsaved = new Map(); // what the storage would not take, by name: {trial, files}; tried again, also once exported
    const restoring = new Set(); // parts of an earlier page that are not a trial yet
    let studyFiles = [];         // of earlier pages
    let carried = {};            // what a study goes on from, by path, beside a storage that is full
    let isCarried = true;        // else it is lost with this page
    let designs = [];            // of earlier pages
    let parts = [];
    let database = null;
    let writing = 0;
    let sending = false;
    let openDialog = () => {};
    let changed = () => {};
    let lastWord = '';         // of the desk
    let persistent = false;
    let open_to_all = false;   // the desk takes logs without a code
    let asksCode = true;       // as far as is known
    let takesNone = false;     // no logs at all

    const remember = (key, value) => {
        try {
            if (value === null) localStorage.removeItem(key);
            else localStorage.setItem(key, value);
            return true;
        } catch (full) {
            return false;
        }
    };
    const recall = (key) => {
        try {
            return localStorage.getItem(key) || '';
        } catch (forbidden) {
            return '';
        }
    };
    const tell = (text) => {
        problems.push(text);
        changed();
    };
    const tellOf = (name, text) => {
        if (told.get(name) === text) return;
        told.set(name, text);
        tell(text);
    };
    // The trial is stored, or at the desk, or in a file.
    const solve = (...names) => {
        for (const name of names) {
            if (told.has(name)) solved.push(told.get(name));
            told.delete(name);
        }
    };

    const hex = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, '0')).join('');
    let tablet = recall('palpa-tablet'); // one name for this page, even where the browser remembers nothing
    const tabletName = () => {
        if (!/^[0-9a-f]{8}$/.test(tablet)) {
            tablet = hex(crypto.getRandomValues(new Uint8Array(4)));
            remember('palpa-tablet', tablet);
        }
        return tablet;
    };
    const asked_for = (key) => new URLSearchParams(location.search).get(key);
    const protocol = () => asked_for('protocol') === null ? '' : asked_for('protocol').replace(/\.json$/, '');
    // as is_code() of study/names.cpp: what tables take for a missing value, or for a sum, is no code
    const isCode = (code) => /^(?!(NA|NULL|NaN|None|nan|null)$)[0-9A-Za-z]{1,64}$/.test(code) && !/^(all|total|sum|overall)$/i.test(code);
    // Who palpates: ?participant=07 in the address, kept; else the tablet itself.
    const participant = () => {
        const asked = asked_for('participant');
        if (protocol() !== '') return asked === null ? '' : asked.slice(0, 64); // a study asks for nobody by itself
        if (asked !== null && isCode(asked)) remember('palpa-participant', asked);
        const kept = recall('palpa-participant');
        return isCode(kept) ? kept : `tablet${tabletName()}`;
    };
    // Names of runs are never given twice, whatever became of their trials.
    const runOf = (name) => Number((/_run-([0-9]+)$/.exec(name) || [0, 0])[1]);
    const nextRun = () => 1 + Math.max(Number(recall('palpa-runs')) || 0, ...[...trials.keys()].map(runOf));
    const current = new Set(); // of this page

    // The address goes on with whoever is here.
    const setParticipant = (code) => {
        const query = new URLSearchParams(location.search);
        if (!query.has('protocol') || (query.get('participant') ?? '') === code) return;
        if (code === '') query.delete('participant');
        else query.set('participant', code);
        history.replaceState(null, '', `${location.pathname}?${query}`);
    };

    const request = (mode, work, stores = ['trials'], durability = 'strict') => new Promise((resolve, reject) => {
        if (database === null) return reject(new Error(palpaWords.noStorage));
        const transaction = database.transaction(stores, mode, mode === 'readwrite' ? {durability} : {});
        const asked = work(...stores.map((store) => transaction.objectStore(store)));
        transaction.oncomplete = () => resolve(asked ? asked.result : undefined);
        transaction.onerror = transaction.onabort = () => reject(transaction.error || new Error(palpaWords.interrupted));
    });

    // Chromium gives no message with a full storage.
    const whyNot = (error) => error.name === 'QuotaExceededError' ? palpaWords.storageFull : error.message;

    const open = () => new Promise((resolve, reject) => {
        const asked = indexedDB.open('palpa', 3);
        asked.onupgradeneeded = () => {
            for (const [store, keyPath] of Object.entries(kStores)) {
                if (!asked.result.objectStoreNames.contains(store)) asked.result.createObjectStore(store, {keyPath});
            }
        };
        asked.onsuccess = () => resolve(asked.result);
        asked.onerror = () => reject(asked.error);
        asked.onblocked = () => reject(new Error(palpaWords.heldElsewhere));
    });

    const note = (trial) => trials.set(trial.name, {name: trial.name, sha256: trial.sha256, finished: trial.finished,
                                                     endedEarly: !!trial.endedEarly, exported: !!trial.exported, sent: !!trial.sent});
    // A list beside the storage: what is missing from that was taken away by the browser.
    const noteNames = () => remember('palpa-kept', JSON.stringify([...trials.values()].filter((t) => !t.sent).map((t) => t.name)));

    const findMissing = () => {
        let names = [];
        try {
            names = JSON.parse(recall('palpa-kept') || '[]');
        } catch (broken) {
            return;
        }
        const gone = names.filter((name) => !trials.has(name));
        if (gone.length > 0) tell(palpaFilled(palpaWords.lost, gone.length, gone.join(', ')));
    };

    // A trial that is at the desk or exported is not asked for again, though the storage has no room to say so.
    const carry = () => {
        const files = {...carried};
        for (const {trial, files: state} of unsaved.values()) {
            if (trial.sent || trial.exported) for (const {path, text} of state) files[path] = text;
        }
        isCarried = remember('palpa-study', Object.keys(files).length > 0 ? JSON.stringify(files) : null);
    };
    // What an earlier page carried, into the storage if there is room now.
    const takeCarried = async () => {
        const files = JSON.parse(recall('palpa-study') || '{}');
        const entries = Object.entries(files).map(([path, text]) => ({path, text}));
        if (entries.length === 0) return;
        studyFiles = [...studyFiles.filter(({path}) => !(path in files)), ...entries];
        const isDone = ({path, name}) => `${path.slice(0, path.lastIndexOf('/'))}/${name}_events.tsv` in files;
        const done = new Set(parts.filter(isDone).map(({name}) => name)); // not broken off
        parts = parts.filter((part) => !isDone(part));
        carried = files;
        await request('readwrite', (store, partsStore) => {
            for (const file of entries) store.put(file);
            for (const name of done) partsStore.delete(IDBKeyRange.bound([name], [name, []]));
        }, ['study', 'parts']).then(() => { carried = {}; }).catch(() => {});
        carry();
    };

    // Two pages would give the same names. The lock goes with the page that holds it.
    const isAlone = () => new Promise((resolve) => {
        if (!navigator.locks) return resolve(noOtherAnswers());
        navigator.locks.request('palpa', {signal: AbortSignal.timeout(kWait_ms)}, () => {
            resolve(true);
            return new Promise(() => {});
        }).catch((error) => resolve(error.name !== 'TimeoutError')); // where storage is refused, locks are too
    });

    // Only https and localhost have locks. Elsewhere the pages ask each other.
    const noOtherAnswers = () => new Promise((resolve) => {
        const channel = new BroadcastChannel('palpa');
        let alone = false;
        const settled = setTimeout(() => { alone = true; resolve(true); }, kAnswer_ms);
        channel.onmessage = ({data}) => {
            if (data === 'who' && alone) channel.postMessage('here');
            if (data !== 'here' || alone) return;
            clearTimeout(settled);
            channel.close();
            resolve(false);
        };
        channel.postMessage('who');
    });

    const start = async (dialog) => {
        openDialog = dialog;
        if (!await isAlone()) throw new Error(palpaWords.secondTab);
        try {
            database = await open();
            database.onclose = () => { database = null; tell(palpaWords.storageClosed); };
            for (const trial of await request('readonly', (store) => store.getAll())) note(trial);
            studyFiles = await request('readonly', (store) => store.getAll(), ['study']);
            designs = await request('readonly', (store) => store.getAll(), ['designs']);
            parts = await request('readonly', (store) => store.getAll(), ['parts']);
            await takeCarried();
            for (const part of parts) restoring.add(part.name);
            findMissing();
            noteNames();
        } catch (error) {
            tell(palpaFilled(palpaWords.cannotStore, error.message));
        }
        askToStay();
        const odd = asked_for('participant');
        if (protocol() === '' && odd !== null && !isCode(odd)) tell(palpaFilled(palpaWords.oddParticipant, odd, participant()));
        await askDesk();
        await pairByAddress();
        window.addEventListener('hashchange', pairByAddress);
        const again = async () => { saveAgain(); if (isPaired() || toSend().length > 0) await askDesk(); send(); changed(); };
        setInterval(again, kAgain_ms);
        window.addEventListener('online', again);
        window.addEventListener('beforeunload', (event) => { if (inDanger() > 0 || !isCarried) event.preventDefault(); });
        send();
    };

    // Some browsers ask the person, who may never answer.
    const askToStay = async () => {
        persistent = await navigator.storage?.persist?.().catch(() => false) ?? false;
        changed();
    };

    // Some desks take logs from everybody, some from nobody. One that does not answer delays the start no longer.
    const askDesk = async () => {
        try {
            const answer = await fetch('api/health', {headers: credentials(), signal: AbortSignal.timeout(kWait_ms)});
            if (!answer.ok || !(answer.headers.get('Content-Type') || '').includes('json')) return;
            const {pairing, collects, paired} = await answer.json();
            if (paired === false && recall('palpa-token')) endPairing();
            asksCode = pairing !== false;
            takesNone = collects === false;
            open_to_all = !asksCode && collects === true;
        } catch (away) {
            // no desk: trials wait here
        }
    };
    const credentials = () => recall('palpa-token') ? {Authorization: `Bearer ${recall('palpa-token')}`} : {};
    const endPairing = () => { // after half a day, or the desk was started anew
        remember('palpa-token', null);
        lastWord = palpaWords.pairAgain;
    };
    const isPaired = () => asksCode && recall('palpa-token') !== '';
    const maySend = () => !takesNone && (open_to_all || isPaired());

    // In one transaction, so that what a study goes on from always fits the trials that are kept.
    const save = async (trial, files, isNew) => {
        await request('readwrite', (store, study, partsStore) => {
            if (isNew) store.add(trial); // never over another page's
            else store.put(trial);
            for (const file of files) study.put(file);
            if (isOver(trial)) partsStore.delete(IDBKeyRange.bound([trial.name], [trial.name, []]));
        }, ['trials', 'study', 'parts']);
        for (const {path} of files) delete carried[path];
        for (const [name, older] of unsaved) { // must not go over it later
            if (name === trial.name) break;
            older.files = older.files.filter((old) => !files.some(({path}) => path === old.path));
        }
        unsaved.delete(trial.name);
        if (onlyInFile().includes(trial.name)) rememberNames('palpa-exported', onlyInFile().filter((name) => name !== trial.name));
        carry();
        solve(trial.name, '');
        note(trial);
        noteNames();
    };

    // Space may have been made meanwhile.
    const saveAgain = async () => {
        for (const {trial, files, isNew} of [...unsaved.values()]) await save(trial, files, isNew).catch(() => {});
        changed();
    };

    const contentOf = (path) => FS.readFile(path, {encoding: 'utf8'});

    // `how`: finished, ended early, going on, or broken off (left by an earlier page). `paths`: of files that the study goes on from.
    const put = async (name, text, sha256, how, paths) => {
        ++writing;
        const broken = how === 'broken-off';
        const endedEarly = how === 'ended-early';
        const finished = endedEarly || how === 'finished';
        const isNew = !broken && (!current.has(name) || !!unsaved.get(name)?.isNew);
        if (!broken) current.add(name);
        restoring.delete(name);
        remember('palpa-runs', String(Math.max(Number(recall('palpa-runs')) || 0, runOf(name))));
        const trial = {name, text, sha256, finished, endedEarly, exported: false, sent: false};
        const files = paths.map((path) => ({path, text: contentOf(path)}));
        try {
            await save(trial, files, isNew);
        } catch (error) {
            unsaved.set(name, {trial, files, isNew});
            if (finished) solve(''); // what is said of the whole trial replaces it
            tellOf(name, palpaFilled(palpaWords.notStored, name, whyNot(error)));
        } finally {
            --writing;
        }
        changed();
        if (finished || broken) send();
    };

    // What was added to a file of the trial that is going on.
    const putPart = (name, path, offset, text) => {
        remember('palpa-runs', String(Math.max(Number(recall('palpa-runs')) || 0, runOf(name))));
        request('readwrite', (store) => { store.put({name, path, offset, text}); }, ['parts'], 'relaxed').catch((error) => {
            if (!told.has('')) tellOf('', palpaFilled(palpaWords.partNotStored, whyNot(error)));
        });
    };

    // What earlier pages left, back into the program's files. Returns the runs that were broken off, as folder/name.
    const restore = () => {
        const write = (path, text) => {
            FS.mkdirTree(path.slice(0, path.lastIndexOf('/')));
            FS.writeFile(path, text);
        };
        for (const {path, text} of [...studyFiles, ...designs]) write(path, text);
        const texts = new Map();
        const bytes = new TextEncoder();
        const sizes = new Map();
        for (const {path, offset, text} of parts) { // sorted by the storage
            if ((sizes.get(path) ?? 0) !== offset) continue; // a part before it is missing
            texts.set(path, (texts.get(path) ?? '') + text);
            sizes.set(path, offset + bytes.encode(text).length);
        }
        for (const [path, text] of texts) write(path, text);
        const broken = [...new Set(parts.map(({name, path}) => `${path.slice(0, path.lastIndexOf('/'))}/${name}`))];
        studyFiles = designs = parts = [];
        return broken.join('\n');
    };

    // Returns false if the desk would take no other trial now either; all are tried again later.
    const sendOne = async (name) => {
        const trial = unsaved.has(name) ? unsaved.get(name).trial : await request('readonly', (store) => store.get(name)).catch(() => null);
        if (!trial || trial.sent) return true;
        const answer = await fetch(`api/logs/${encodeURIComponent(name)}`, {
            method: 'PUT',
            headers: {'Content-Type': 'application/json', 'X-Content-SHA256': trial.sha256, ...credentials()},
            body: trial.text,
            signal: AbortSignal.timeout(kSend_ms),
        });
        if (answer.status === 401 || answer.status === 403) {
            endPairing();
            return false;
        }
        const confirmed = answer.ok ? (await answer.json()).sha256 : '';
        if (confirmed !== trial.sha256) {
            lastWord = answer.ok ? palpaFilled(palpaWords.checksumMismatch, name) : palpaFilled(palpaWords.answered, answer.status, name);
            if (answer.status === 503) await askDesk(); // it was started again, without a folder for logs
            if (takesNone) lastWord = '';
            return kOfOneTrial.includes(answer.status);
        }
        // the desk has it: from here on only its name is kept
        const sent = {...trial, text: '', sent: true};
        if (unsaved.has(name)) {
            unsaved.get(name).trial = sent; // what the study goes on from still has no place
            await save(sent, unsaved.get(name).files, false).catch(carry);
        } else {
            await save(sent, [], false).catch(() => unsaved.set(name, {trial: sent, files: [], isNew: false})); // full
        }
        solve(name, '');
        note(sent);
        noteNames();
        return true;
    };

    // A trial that is going on is neither sent nor exported, since its files still grow; one that an earlier page left is.
    const isOver = (t) => t.finished || (!current.has(t.name) && !restoring.has(t.name));
    const known = () => [...[...trials.values()].filter((t) => !unsaved.has(t.name)), ...[...unsaved.values()].map(({trial}) => trial)];
    const toSend = () => known().filter((t) => !t.sent && isOver(t));

    const send = async () => {
        if (sending || !maySend()) return;
        sending = true;
        if (toSend().length > 0) lastWord = '';
        try {
            for (const {name} of toSend()) {
                if (!await sendOne(name)) break;
            }
        } catch (error) {
            lastWord = palpaWords.trialsWait;
        } finally {
            sending = false;
        }
        changed();
    };

    const pair = async (code) => {
        try {
            const answer = await fetch('api/pair', {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({code}),
                                                    signal: AbortSignal.timeout(kPair_ms)});
            const token = answer.ok ? (await answer.json()).token : '';
            if (token) remember('palpa-token', token);
            lastWord = token                 ? palpaWords.paired
                     : answer.status === 429 ? palpaFilled(palpaWords.codesLocked, answer.headers.get('Retry-After') ?? '')
                                             : palpaFilled(palpaWords.wrongCode, answer.status);
        } catch (error) {
            lastWord = palpaWords.notReachable;
        }
        changed();
        await send();
    };

    // The square that the desk shows says #code=...
    const pairByAddress = async () => {
        const code = new URLSearchParams(location.hash.slice(1)).get('code');
        if (!code || !asksCode) return;
        history.replaceState(null, '', location.pathname + location.search);
        await pair(code);
        if (!isPaired()) tell(lastWord);
    };

    const download = (name, text) => {
        const link = document.createElement('a');
        link.href = URL.createObjectURL(new Blob([text], {type: 'application/json'}));
        link.download = name;
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    };

    const unstored = new Set(); // changed parts that are only on this page
    const keepDesign = (path) => {
        request('readwrite', (store) => { store.put({path, text: contentOf(path)}); }, ['designs']).then(() => unstored.delete(path), (error) => {
            unstored.add(path);
            tell(palpaFilled(palpaWords.designNotStored, whyNot(error)));
        });
    };
    const offer = (path) => download(path.slice(path.lastIndexOf('/') + 1), contentOf(path));

    // All that the desk does not have, in one file; also what the storage would not take. Studies never share one.
    const exportAll = async () => {
        const kept = trials.size === 0 ? [] : (await request('readonly', (store) => store.getAll()).catch((error) => {
            tell(palpaFilled(palpaWords.cannotRead, error.message));
            return [];
        })).filter((t) => !t.sent);
        const all = [...kept.filter((t) => !unsaved.has(t.name)), ...[...unsaved.values()].map(({trial}) => trial)].filter((t) => !t.sent && isOver(t));
        const studies = new Map(); // by study.json: its name, and its files
        for (const trial of all) {
            const {files} = JSON.parse(trial.text);
            const identity = files.find((file) => file.name === 'study.json');
            const key = identity ? identity.sha256 : '';
            if (!studies.has(key)) studies.set(key, {title: identity ? `-${JSON.parse(identity.text).protocol.replace(/[^0-9A-Za-z]+/g, '-')}` : '', files: new Map()});
            for (const file of files) studies.get(key).files.set(`${file.name} ${file.sha256}`, file);
        }
        const day = new Date().toISOString().replace(/[-:]|\.\d+/g, '');
        for (const {title, files} of studies.values()) {
            download(`palpa-trials${title}-${tabletName()}-${day}.json`, JSON.stringify({palpa_bundle: 1, files: [...files.values()]}, null, 1) + '\n');
        }
        for (const {trial} of unsaved.values()) trial.exported = true;
        rememberNames('palpa-exported', [...onlyInFile(), ...unsaved.keys()]);
        carry();
        solve(...unsaved.keys());
        for (const trial of kept.filter(isOver)) {
            note({...trial, exported: true});
            await request('readwrite', (store) => store.put({...trial, exported: true})).catch(() => {}); // full: known until the page is left
        }
        changed();
    };

    const codeOf = (name) => (/^sub-([0-9A-Za-z]+)_task-(?!answers_)/.exec(name) || ['', ''])[1]; // of who did a trial
    const deleted = () => recall('palpa-deleted').split(' '); // codes of participants, also of earlier pages
    const onlyInFile = () => recall('palpa-exported').split(' '); // names of trials for which there was no room, also of earlier pages
    const rememberNames = (key, names) => remember(key, [...new Set(names)].join(' '));

    // What is at the desk takes no room, and its name counts there.
    const removeExported = async () => {
        for (const {name, exported, sent} of [...trials.values()]) {
            if (!exported || sent) continue;
            await request('readwrite', (store) => store.delete(name));
            trials.delete(name);
            rememberNames('palpa-deleted', [...deleted(), codeOf(name)]);
        }
        noteNames();
        lastWord = ''; // it may be of one of them
        await saveAgain(); // there may be room now
    };

    const isInDanger = (trial) => unsaved.has(trial.name) && !trial.exported && !trial.sent;
    const inDanger = () => known().filter(isInDanger).length;
    const words = (trial) => {
        if (isInDanger(trial)) return palpaWords.exportIt;
        if (trial.sent) return palpaWords.atDesk;
        if (!isOver(trial)) return palpaWords.inProgress;
        return (trial.finished && !trial.endedEarly ? palpaWords.waiting : palpaWords.interruptedWaiting) + (trial.exported ? palpaWords.exported : '');
    };

    // Where the trials of one participant are, for people; and whether answers, or a withdrawal, wait here alone.
    const where = (code) => {
        const all = known().filter((t) => codeOf(t.name) === code && isOver(t));
        const sent = all.some((t) => t.sent);
        const here = all.some((t) => !t.sent && !unsaved.has(t.name));
        const exported = deleted().includes(code) || onlyInFile().some((name) => codeOf(name) === code) || all.some((t) => !t.sent && unsaved.has(t.name)); // and nowhere else
        if (here) return sent || exported ? palpaWords.someAreHere : palpaWords.theyAreHere;
        const answers = known().some((t) => !t.sent && !t.exported && t.name.startsWith(`sub-${code}_task-answers_`));
        return [exported ? palpaWords.noneIsHere : sent ? palpaWords.theyAreAtDesk : '', answers ? palpaWords.answersAreHere : ''].filter(Boolean).join(' ');
    };

    const state = () => {
        const waiting = toSend().length;
        const paired = maySend();
        const lines = [palpaFilled(palpaWords.howMany, waiting, [...trials.values()].filter((t) => t.sent).length)];
        lines.push(takesNone ? palpaWords.takesNoLogs : isPaired() ? palpaWords.isPaired : open_to_all ? palpaWords.openToAll : palpaWords.notPaired);
        if (!persistent) lines.push(palpaWords.mayDelete);
        if (lastWord) lines.push(lastWord);
        return {lines, paired, waiting, asksCode: asksCode && !isPaired(), trials: known().map((t) => ({...t, words: words(t)}))};
    };

    const noteText = () => {
        const waiting = toSend().filter((t) => !unsaved.has(t.name)).length; // the others are exported
        if (inDanger() > 0) return palpaFilled(palpaWords.unsaved, inDanger());
        return waiting === 0 ? palpaWords.allSafe : palpaFilled(maySend() ? palpaWords.storedUnsent : palpaWords.stored, waiting);
    };

    return {
        stores: () => database !== null,
        start, put, putPart, restore, tell, send, pair, exportAll, removeExported, state, request, credentials, protocol, setParticipant,
        ready: () => writing === 0 && inDanger() === 0,
        keepsDesigns: () => unstored.size === 0,
        nextProblem: () => problems.shift() || '',
        nextSolved: () => solved.shift() || '',
        note: () => trials.size + unsaved.size > 0 ? noteText() : palpaWords.storedHere,
        participant, nextRun, where,
        settings: () => recall('palpa-settings'),
        keepSettings: (text) => { if (!remember('palpa-settings', text)) tell(palpaWords.settingsNotStored); },
        keepDesign, offer,
        open: () => openDialog(),
        onChange: (callback) => { changed = callback; },
    };
})();
