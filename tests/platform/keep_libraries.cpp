// Linked into tests that draw. Mesa's drivers are unloaded before LeakSanitizer looks, which then can neither
// find the memory that they still point to nor name them; so nothing is unloaded.
extern "C" int dlclose(void*) { return 0; }
