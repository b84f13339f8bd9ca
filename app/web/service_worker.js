// The app works without a network after the first visit. One cache per build, named by the hash of its files.
'use strict';

const kCache = 'palpa-@HASH@';
const kFiles = [@FILES@];

self.addEventListener('install', (event) => {
    event.waitUntil(caches.open(kCache).then((cache) => cache.addAll(kFiles.map((file) => new Request(file, {cache: 'reload'})))));
    self.skipWaiting();
});

// The build before this one is left: a page that is just starting may still ask for its files.
self.addEventListener('activate', (event) => {
    event.waitUntil(caches.keys().then((names) => {
        const ours = names.filter((name) => name.startsWith('palpa-'));
        return Promise.all(ours.slice(0, -2).map((name) => caches.delete(name)));
    }).then(() => self.clients.claim()));
});

self.addEventListener('fetch', (event) => {
    const url = new URL(event.request.url);
    const scope = new URL(self.registration.scope);
    const path = url.pathname.slice(scope.pathname.length);
    if (event.request.method !== 'GET' || url.origin !== scope.origin || path.startsWith('api/')) return;
    event.respondWith((async () => {
        const name = path === '' ? 'index.html' : path;
        const newest = await (await caches.open(kCache)).match(name);
        return newest || await caches.match(name) || fetch(event.request);
    })());
});
