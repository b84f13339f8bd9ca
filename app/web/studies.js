// Protocols, and the scenes, maps, profiles and phantoms that they name: those of the app, and those that the desk serves,
// which are kept in the browser's storage for days without a network. Of two of one name the desk's is taken.
'use strict';

const palpaStudies = (() => {
    const kKinds = ['protocols', 'scenes', 'maps', 'profiles', 'phantoms'];
    const kDefaultProfile = 'profiles/s-pen.json'; // of scenes that name none
    const kAssets = '/assets';
    const kWait_ms = 5000;
    let kept = new Map(); // by path in the assets: {path, bytes, files}; `files` of a protocol: all it needs

    const textOf = (bytes) => new TextDecoder().decode(bytes);
    // Hand-written JSON has comments.
    const parse = (text) => {
        try {
            return JSON.parse(text.replace(/("(?:[^"\\]|\\.)*")|\/\/[^\n]*|\/\*[^]*?\*\//g, (all, word) => word ?? ''));
        } catch (broken) {
            return null; // the program says what is wrong with it
        }
    };
    const words = (json) => typeof json === 'string' ? [json] : json && typeof json === 'object' ? Object.values(json).flatMap(words) : [];
    const plain = (path) => {
        const out = [];
        for (const part of path.split('/')) {
            if (part === '..') out.pop();
            else if (part !== '' && part !== '.') out.push(part);
        }
        return out.join('/');
    };

    // A protocol and all that it names, as far as `paths` has it.
    const collect = async (protocol, paths, read) => {
        const found = new Map();
        const waiting = [protocol];
        while (waiting.length > 0) {
            const path = waiting.pop();
            if (found.has(path)) continue;
            found.set(path, await read(path));
            if (!path.endsWith('.json')) continue;
            const folder = path.slice(0, path.lastIndexOf('/'));
            for (const word of words(parse(textOf(found.get(path))))) {
                for (const named of [folder, ...kKinds].map((base) => plain(`${base}/${word}`))) {
                    if (paths.has(named)) waiting.push(named);
                    if (named.endsWith('.map')) waiting.push(...[...paths].filter((file) => file.startsWith(named + '/')));
                }
            }
            if (path.startsWith('scenes/') && paths.has(kDefaultProfile)) waiting.push(kDefaultProfile);
        }
        return found;
    };

    const ask = async (address) => {
        const answer = await fetch(address, {headers: palpaTrials.credentials(), cache: 'no-cache', signal: AbortSignal.timeout(kWait_ms)});
        if (!answer.ok) throw Object.assign(new Error(palpaFilled(palpaWords.answered, answer.status, address)), {status: answer.status});
        return answer;
    };
    const askFile = async (path) => (await ask('files/' + path.split('/').map(encodeURIComponent).join('/'))).arrayBuffer();
    const atDesk = async () => {
        const listed = await (await ask('api/files')).json();
        const files = kKinds.flatMap((kind) => listed[kind] ?? []).flatMap((entry) => entry.files ?? [entry]);
        return new Set(files.map(({path}) => path.replace(/^\/files\//, '')));
    };

    // The desk's newest version of a protocol, all of it or nothing. False: the desk has none.
    const fetchStudy = async (name) => {
        const protocol = `protocols/${name}.json`;
        const paths = await atDesk();
        if (!paths.has(protocol)) return false;
        const found = await collect(protocol, paths, askFile).catch(() => { throw {status: 'cut'}; });
        const entries = [...found].map(([path, bytes]) => ({path, bytes, files: path === protocol ? [...found.keys()] : kept.get(path)?.files}));
        await palpaTrials.request('readwrite', (store) => { for (const entry of entries) store.put(entry); }, ['files']).catch(() => {}); // full: for this page
        for (const entry of entries) kept.set(entry.path, entry);
        return true;
    };

    const start = async () => {
        try {
            for (const entry of await palpaTrials.request('readonly', (store) => store.getAll(), ['files'])) kept.set(entry.path, entry);
        } catch (none) {
            // no storage: told elsewhere
        }
        const name = palpaTrials.protocol();
        if (name) await fetchStudy(name).catch(({status}) => { // what is kept, or of the app
            if (status === 401) palpaTrials.tell(palpaWords.studyUnpaired);
            if (status === 'cut') palpaTrials.tell(palpaWords.studyCut);
        });
    };

    // The desk's files of the study that was asked for take the place of the app's.
    const restore = () => {
        const files = kept.get(`protocols/${palpaTrials.protocol()}.json`)?.files ?? [];
        const maps = new Set(files.filter((path) => path.startsWith('maps/')).map((path) => `${kAssets}/${path.slice(0, path.lastIndexOf('/'))}`));
        for (const map of maps) {
            if (!FS.analyzePath(map).exists) continue;
            for (const file of FS.readdir(map)) if (!file.startsWith('.')) FS.unlink(`${map}/${file}`); // no part of another version stays
        }
        for (const path of files) {
            const to = `${kAssets}/${path}`;
            FS.mkdirTree(to.slice(0, to.lastIndexOf('/')));
            FS.writeFile(to, new Uint8Array(kept.get(path).bytes));
        }
    };

    const inApp = async (path) => FS.readFile(`${kAssets}/${path}`, {encoding: 'utf8'});

    // Conditions whose scene drives a device, or whose calibration profile reads a pen's counts, need the desk's machine. Of
    // scenes that cannot be read it is not known. The program says what is wrong with a protocol that is none.
    const needsDesk = async (protocol, read) => {
        const found = async (name, kind, beside) =>
            await read(plain(`${beside}/${name}`)).catch(() => read(`${kind}/${name}`)).catch(() => inApp(`${kind}/${name}`)).catch(() => null);
        for (const condition of [protocol?.conditions].flat()) {
            const {modality, scene, profile} = Object(condition);
            if (!scene || modality === 'hand') continue;
            const text = await found(scene, 'scenes', 'protocols');
            const key = {'shape-display': 'tactile', tangible: 'tangible'}[modality];
            const itself = Object(parse(text ?? ''));
            if (key && (text === null || key in itself)) return true;
            const name = profile ?? itself.profile;
            if (key || typeof name !== 'string') continue;
            const its = await found(name, 'profiles', profile ? 'protocols' : 'scenes');
            if (its !== null && Object(parse(its)).level === 'pressure_raw') return true;
        }
        return false;
    };

    // What can be chosen: {name, title, from}, by name.
    const list = async () => {
        const out = new Map();
        const elsewhere = new Map();
        const isProtocol = (path) => path.startsWith('protocols/') && path.endsWith('.json');
        const add = async (paths, from, read) => {
            for (const path of paths.filter(isProtocol)) {
                const name = path.slice('protocols/'.length, -5);
                const protocol = parse(await read(path));
                const title = protocol?.name ?? name;
                const needs = await needsDesk(protocol, read);
                out.delete(name);
                elsewhere.delete(name);
                if (needs) elsewhere.set(name, title);
                else out.set(name, {name, title, from});
            }
        };
        await add(FS.readdir(`${kAssets}/protocols`).map((file) => `protocols/${file}`), palpaWords.inTheApp, inApp);
        await add([...kept.keys()], palpaWords.ofDeskStored, async (path) => textOf(kept.get(path).bytes));
        let said = '';
        try {
            await add([...await atDesk()], palpaWords.ofDesk, async (path) => textOf(await askFile(path)));
        } catch (away) {
            said = palpaWords.noDesk;
        }
        if (elsewhere.size > 0) said = [said, palpaFilled(palpaWords.drivesDevices, [...elsewhere.values()].sort().join(', '))].filter(Boolean).join(' ');
        return {studies: [...out.values()].sort((a, b) => a.title < b.title ? -1 : 1), said};
    };

    const begin = (name, participant) => {
        const query = new URLSearchParams({protocol: name, ...(participant ? {participant} : {})});
        location.assign(`${location.pathname}?${query}`);
    };
    const leave = () => location.assign(location.pathname);

    return {start, restore, list, begin, leave};
})();
